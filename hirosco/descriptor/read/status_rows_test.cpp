// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/status_rows.hpp"

#include <algorithm>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

const std::filesystem::path supervisor_file = std::filesystem::path{HIROSCO_SOURCE_DIR} / "supervisor/supervisor.xml";

/// The supervisor of every mission, with so many subsystems and links.
Mission crew_of(std::size_t subsystems, std::size_t links) {
  Mission mission;
  mission.supervisor = read_subsystem(supervisor_file, file_system()).value.value();
  mission.subsystems.resize(subsystems);
  mission.links.resize(links);
  return mission;
}

std::vector<std::size_t> lengths(const Mission& mission, std::string_view structure) {
  std::vector<std::size_t> counts;
  for (const auto& parameter : mission.supervisor.parameters)
    if (parameter.field.name == structure)
      for (const auto& column : parameter.members) counts.push_back(column.field.count);
  return counts;
}

TEST(StatusRows, AreSixteenInSmallMissionsSoThatTheirReportsStayAsTheyAre) {
  Mission mission = crew_of(15, 16);
  EXPECT_EQ(give_everybody_a_row(mission), "");
  EXPECT_EQ(lengths(mission, subsystem_rows), std::vector<std::size_t>(10, 16));
  EXPECT_EQ(lengths(mission, link_rows), std::vector<std::size_t>(7, 16));
  EXPECT_EQ(lengths(mission, link_quality_rows), std::vector<std::size_t>(6, 16));
  EXPECT_EQ(lengths(mission, link_latency_rows), std::vector<std::size_t>(11, 16));
}

TEST(StatusRows, AreOneForEachOfMany) {
  Mission mission = crew_of(16, 17);
  EXPECT_EQ(give_everybody_a_row(mission), "");
  EXPECT_EQ(lengths(mission, subsystem_rows), std::vector<std::size_t>(10, 17)) << "the supervisor has one, too";
  EXPECT_EQ(lengths(mission, link_rows), std::vector<std::size_t>(7, 17));
  EXPECT_EQ(lengths(mission, link_quality_rows), std::vector<std::size_t>(6, 17));
  EXPECT_EQ(lengths(mission, link_latency_rows), std::vector<std::size_t>(11, 17));
  mission = crew_of(60, 90);
  EXPECT_EQ(give_everybody_a_row(mission), "");
  EXPECT_EQ(lengths(mission, subsystem_rows), std::vector<std::size_t>(10, 61));
}

TEST(StatusRows, OfLatenciesAreAsManyAsOnePacketTakes) {
  Mission mission = crew_of(3, 120);  // 4 rows of 29 octets and 120 of 22 fit, 120 of 41 do not
  EXPECT_EQ(give_everybody_a_row(mission), "");
  EXPECT_EQ(lengths(mission, link_rows), std::vector<std::size_t>(7, 120));
  EXPECT_EQ(lengths(mission, link_latency_rows), std::vector<std::size_t>(11, 99));
}

TEST(StatusRows, ThatFillMoreThanAPacketAreRefused) {
  Mission mission = crew_of(100, 100);  // 101 rows of 29 octets, 100 of 22, and the mode
  EXPECT_EQ(give_everybody_a_row(mission), "its report 4702 takes 5130 octets, at most 4072");
  mission = crew_of(128, 1);
  EXPECT_EQ(give_everybody_a_row(mission), "SUBSYSTEMS has 129 rows, at most 128");
}

TEST(StatusRows, AMissionWithMoreThanTheyHoldIsRefusedByItsReader) {
  std::string many;
  for (int id = 100; id < 230; ++id) {
    const std::string number = std::to_string(id);
    many += R"(<Subsystem executable="flywheel" descriptor="flywheel.xml" name="WHEEL_)" + number + R"(" id=")" +
            number + R"("><Device name="STICK" address="stick_)" + number + R"("/></Subsystem>)";
  }
  const std::string links = "<Links>";
  const auto source = testing::overlay({{"mission.xml", testing::changed(links, many + links)},
                                        {"supervisor.xml", file_system()(supervisor_file).value()}});
  const auto reading = read_mission(testing::data / "mission.xml", source);
  EXPECT_EQ(std::ranges::count(reading.problems, "E0328", &Diagnostic::code), 1)
      << testing::rendered(reading.problems, source);
}

}  // namespace
}  // namespace hirosco::descriptor
