// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/robot_world.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

class WorldOfRobots : public ::testing::Test {
 protected:
  WorldOfRobots() {
    std::string name = fs::temp_directory_path() / "hirosco-world-XXXXXX";
    templates_ = ::mkdtemp(name.data());
  }
  ~WorldOfRobots() override { fs::remove_all(templates_); }
  fs::path templates_;
};

TEST_F(WorldOfRobots, IsTheOneThatTheTemplateFliesIn) {
  fs::create_directory(templates_ / "robot");
  std::ofstream{templates_ / "robot/mission.xml"} << R"(<Subsystem executable="hirosco-sim-no-device"/>
@a@ <SimulatedDevice name="a" executable="hirosco-sim-tank" subsystem="A"/>)";
  const RobotWorld world = robot_world(templates_);
  EXPECT_EQ(world.program, "hirosco-sim-tank");
  EXPECT_EQ(world.word, "tank");
  EXPECT_EQ(world.package, "hirosco-world-tank");
  EXPECT_EQ(world.fetcher, "fetch_tank");
  EXPECT_EQ(world.library, "libtank.so.");
}

TEST_F(WorldOfRobots, IsNoneWithoutATemplate) {
  EXPECT_EQ(robot_world(templates_).program, "");
  EXPECT_EQ(robot_world({}).package, "");
}

/// What is called by its word is called so where it is made.
TEST_F(WorldOfRobots, HasAPackageAndAFetcherOfItsWord) {
  const fs::path sources{HIROSCO_SOURCE_DIR};
  const RobotWorld world = robot_world(sources / "templates");
  EXPECT_NE(world.word, "");
  EXPECT_TRUE(fs::is_regular_file(sources / "tools" / world.fetcher)) << world.fetcher;
  const auto text_of = [&](const char* name) {
    std::ifstream file{sources / "tools" / name};
    return std::string{std::istreambuf_iterator<char>{file}, {}};
  };
  EXPECT_NE(text_of("packages/debian/control").find("\nPackage: " + world.package + '\n'), std::string::npos);
  EXPECT_NE(text_of(world.fetcher.c_str()).find(world.library), std::string::npos);
}

}  // namespace
}  // namespace hirosco::tools
