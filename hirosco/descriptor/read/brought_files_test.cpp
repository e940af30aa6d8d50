// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/read/brought_files.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string coronagraph = file_system()(testing::data / "coronagraph.xml").value();
const std::string robot_text = "<robot><link><mesh filename='parts/a.stl'/><mesh filename='../b.stl'/></link></robot>";
const std::string other_robot = "<robot><link><mesh filename='parts/c.stl'/></link></robot>";

/// Its device says more.
[[nodiscard]] std::string coronagraph_with(const std::string& settings) {
  return testing::changed("<Setting ", settings + "<Setting ", coronagraph);
}

TEST(BroughtFiles, AreThoseThatTheFilesOfSettingsNameEachOnce) {
  SubsystemDescriptor arm;
  arm.file = "/missions/arm/arm.xml";
  arm.configurations.resize(2);
  for (Configuration& configuration : arm.configurations) {
    configuration.devices.resize(1);
    configuration.devices[0].settings = {
        {"MODEL_FILE", "../robots/r.urdf", {}}, {"MAP_FILE", "map.txt", {}}, {"MODEL", "s.urdf", {}}};
  }
  std::vector<std::string> asked;
  const auto source = [&](const std::filesystem::path& file) -> Result<std::string> {
    asked.push_back(file.string());
    return robot_text;
  };
  EXPECT_THAT(brought_files(arm, source), ElementsAre("/missions/robots/parts/a.stl"));
  EXPECT_THAT(asked, ElementsAre("/missions/robots/r.urdf")) << "nobody knows what a map names";
}

TEST(BroughtFiles, AreNoneOfAFileThatIsNotThere) {
  SubsystemDescriptor arm;
  arm.configurations.resize(1);
  arm.configurations[0].devices.resize(1);
  arm.configurations[0].devices[0].settings = {{"MODEL_FILE", "r.urdf", {}}};
  EXPECT_THAT(brought_files(arm, [](const auto&) { return fail(ErrorCode::NotFound, "does not exist"); }), IsEmpty());
}

TEST(BroughtFiles, AreLookedUpWithTheMissionAndAnewWhenADescriptorIsReadAgain) {
  const auto text = coronagraph_with(R"(<Setting name="MODEL_FILE" value="r.urdf"/>)");
  const Mission flown =
      read_mission(testing::data / "mission.xml", testing::overlay({{"coronagraph.xml", text}, {"r.urdf", robot_text}}))
          .value.value();
  const auto of = [](const Mission& mission) { return mission.find_subsystem("CORONAGRAPH")->brought; };
  EXPECT_THAT(of(flown), ElementsAre(testing::data / "parts/a.stl"));
  EXPECT_THAT(flown.find_subsystem("FLYWHEEL")->brought, IsEmpty());
  EXPECT_EQ(*flown.texts.at(testing::data / "r.urdf"), robot_text)
      << "who goes on for a supervisor asks no disk for it";
  const auto again = read_again(flown, testing::data / "coronagraph.xml", text,
                                testing::overlay({{"r.urdf", other_robot}, {"mission.xml", "is not asked for"}}));
  ASSERT_TRUE(again.value) << testing::rendered(again.problems, file_system());
  EXPECT_THAT(of(*again.value), ElementsAre(testing::data / "parts/c.stl"));
}

}  // namespace
}  // namespace hirosco::descriptor
