// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "hirosco/descriptor/model/response_time.hpp"
#include "hirosco/descriptor/testing.hpp"

/// Cycles that samples start (adr 0094): what is read, and what a mission reckons with.
namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;
using testing::rendered;

/// The example's mission with FLYWHEEL's cycle as said, PLATE_STATE with these methods at both ends, and link 1 as said.
Reading<Mission> flown_with(const std::string& flywheel, const std::string& methods = "shared_memory",
                            const std::string& link = {}) {
  const auto file = [](const char* name) { return file_system()(data / name).value(); };
  const std::string attribute = "methods=\"" + methods + "\"";
  return read_mission(
      data / "mission.xml",
      overlay(
          {{"mission.xml", changed("to=\"FLYWHEEL.PLATE_STATE\"", "to=\"FLYWHEEL.PLATE_STATE\" " + link)},
           {"coronagraph.xml",
            changed("methods=\"shared_memory\"", attribute,
                    changed(R"(<Configuration name="COUPLED")", R"(<Configuration name="COUPLED" budget_us="120")",
                            file("coronagraph.xml")))},
           {"flywheel.xml", changed("name=\"PLATE_STATE\" from", "name=\"PLATE_STATE\" " + attribute + " from",
                                    changed(R"(<Configuration name="COUPLED")",
                                            "<Configuration name=\"COUPLED\" " + flywheel, file("flywheel.xml")))}}));
}

TEST(StartedBy, NamesARequiredSetAndTheShortestDistance) {
  const auto reading = flown_with(R"(started_by="PLATE_STATE" least_us="250" budget_us="100")");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const SubsystemDescriptor& flywheel = reading.value->find_subsystem("FLYWHEEL")->subsystem;
  const Configuration& started = *flywheel.find_configuration("COUPLED");
  EXPECT_EQ(started.started_by, "PLATE_STATE");
  EXPECT_EQ(started.sampling, 500us);
  EXPECT_EQ(started.shortest(), 250us);
  for (const Requires& set : started.requires_) EXPECT_EQ(set.starts, set.name == "PLATE_STATE");
  const SubsystemDescriptor& other = reading.value->find_subsystem("CORONAGRAPH")->subsystem;
  const Configuration& by_clock = *other.find_configuration("COUPLED");
  EXPECT_EQ(by_clock.shortest(), by_clock.sampling);
  for (const Requires& set : by_clock.requires_) EXPECT_FALSE(set.starts);
}

TEST(StartedBy, TheLeastDistanceIsWhatACycleCostsTheProcessor) {
  const auto fits = flown_with(R"(started_by="PLATE_STATE" least_us="250" budget_us="100")");
  ASSERT_TRUE(fits.value);
  EXPECT_DOUBLE_EQ(cycle_share(*fits.value, *fits.value->find_mode("telepresence")), 0.64);
  const auto much = flown_with(R"(started_by="PLATE_STATE" least_us="125" budget_us="100")");
  ASSERT_EQ(much.problems.size(), 1U) << rendered(much.problems, file_system());
  EXPECT_EQ(much.problems[0].code, "E0324");
  EXPECT_EQ(much.problems[0].message, "the cycles of mode 'telepresence' take 104 % of a processor");
}

TEST(StartedBy, AMissionSendsItBySomeWayThatWakes) {
  constexpr auto started = R"(started_by="PLATE_STATE" least_us="250" budget_us="100")";
  EXPECT_TRUE(flown_with(started, "shared_memory udp").value);
  EXPECT_TRUE(flown_with(started, "shared_memory udp", R"(method="shared_memory")").value);
  EXPECT_TRUE(flown_with(R"(budget_us="100")", "shared_memory udp", R"(method="udp")").value);
  const auto deaf = flown_with(started, "shared_memory udp", R"(method="udp")");
  ASSERT_FALSE(deaf.problems.empty());
  EXPECT_NE(deaf.problems[0].message.find("its samples start a cycle, and 'udp' wakes nobody"), std::string::npos)
      << rendered(deaf.problems, file_system());
}

}  // namespace
}  // namespace hirosco::descriptor
