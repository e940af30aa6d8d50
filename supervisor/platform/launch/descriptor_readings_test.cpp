// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/descriptor_readings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <thread>

/// What the disk says of a descriptor while its mission flies.
namespace hirosco::supervisor {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

const std::filesystem::path mission =
    std::filesystem::path{HIROSCO_SOURCE_DIR} / "hirosco/descriptor/testdata/mission.xml";

struct DescriptorReadingsTest : ::testing::Test {
  std::map<std::string, std::string> files;  ///< in place of those of this name
  std::vector<std::string> asked;
  descriptor::FileSource source = [this](const std::filesystem::path& wanted) -> Result<std::string> {
    asked.push_back(wanted.filename().string());
    const auto found = files.find(asked.back());
    return found != files.end() ? found->second : descriptor::file_system()(wanted);
  };
  descriptor::Mission flown = descriptor::read_mission(mission, descriptor::file_system()).value.value();
  std::filesystem::path file = flown.find_subsystem("FLYWHEEL")->subsystem.file;
  [[nodiscard]] std::string text_with(const std::string& from, const std::string& to) const {
    std::string text = *flown.find_subsystem("FLYWHEEL")->subsystem.text;
    return text.replace(text.find(from), from.size(), to);
  }
};

TEST_F(DescriptorReadingsTest, TheOtherFilesAreAsTheyWereWhenTheFlightBegan) {
  files["flywheel.xml"] = text_with("maximum=\"0.1\"", "maximum=\"0.2\"");
  files["mission.xml"] = files["coronagraph.xml"] = files["supervisor.xml"] = "no descriptor any more";
  const auto reading = read_now(flown, file, source);
  ASSERT_TRUE(reading.mission.value);
  EXPECT_EQ(*reading.text, files["flywheel.xml"]);
  const auto* function = reading.mission.value->find_subsystem("FLYWHEEL")->subsystem.find_function("SET_FORCE_SCALE");
  EXPECT_EQ(function->arguments[0].field.maximum, parse_number("0.2"));
  EXPECT_THAT(asked, ::testing::ElementsAre("flywheel.xml"));
}

TEST_F(DescriptorReadingsTest, WhatItsFilesBringAlongIsLookedUpOnTheDiskAnew) {
  const std::string settings = R"(<Setting name="MODEL_FILE" value="coronagraph.urdf"/>)";
  file = flown.find_subsystem("CORONAGRAPH")->subsystem.file;
  std::string text = *flown.find_subsystem("CORONAGRAPH")->subsystem.text;
  files["coronagraph.xml"] = text.insert(text.find("<Setting "), settings);
  for (const char* mesh : {"a.stl", "b.stl"}) {
    files["coronagraph.urdf"] = std::string{"<robot><mesh filename='"} + mesh + "'/></robot>";
    const auto reading = read_now(flown, file, source);
    ASSERT_TRUE(reading.mission.value);
    EXPECT_THAT(reading.mission.value->find_subsystem("CORONAGRAPH")->brought,
                ::testing::ElementsAre(file.parent_path() / mesh));
    flown = *reading.mission.value;
  }
}

TEST_F(DescriptorReadingsTest, AllProblemsAreToldWithTheirPlaces) {
  files["flywheel.xml"] =
      text_with(R"(type="DOUBLE" count="2" unit="rad"/>)", R"(type="DOUBLE" count="none" wrong="x"/>)");
  const auto reading = read_now(flown, file, source);
  EXPECT_FALSE(reading.mission.value);
  ASSERT_EQ(reading.mission.problems.size(), 2U);
  for (const auto& problem : reading.mission.problems) {
    EXPECT_THAT(problem.file.string(), EndsWith("flywheel.xml"));
    EXPECT_GT(problem.at.line, 1);
  }
}

TEST_F(DescriptorReadingsTest, WhoUsesWhatIsGoneIsNamedInItsOwnFile) {
  files["flywheel.xml"] = text_with(R"(name="SET_FORCE_SCALE")", R"(name="SET_SCALE")");
  const auto reading = read_now(flown, file, source);
  EXPECT_FALSE(reading.mission.value);
  ASSERT_FALSE(reading.mission.problems.empty());
  EXPECT_THAT(reading.mission.problems.front().file.string(), EndsWith("mission.xml"));
  EXPECT_THAT(reading.mission.problems.front().message, HasSubstr("SET_FORCE_SCALE"));
}

TEST_F(DescriptorReadingsTest, AFileThatCannotBeReadIsAProblem) {
  const auto reading = read_now(flown, "/nowhere/flywheel.xml", descriptor::file_system());
  ASSERT_EQ(reading.mission.problems.size(), 1U);
  EXPECT_EQ(reading.mission.problems.front().code, "E0001");
}

TEST_F(DescriptorReadingsTest, AThreadReadsAndOneAtATime) {
  ThreadedReadings readings;
  EXPECT_FALSE(readings.outcome());
  ASSERT_TRUE(readings.begin(flown, file));
  EXPECT_EQ(readings.begin(flown, file).error().code, ErrorCode::Unavailable);
  std::optional<DescriptorReading> found;
  while (!(found = readings.outcome())) std::this_thread::yield();
  EXPECT_TRUE(found->mission.value);
  EXPECT_FALSE(readings.outcome()) << "each once";
  EXPECT_TRUE(readings.begin(flown, file));
  while (!readings.outcome()) std::this_thread::yield();
}

}  // namespace
}  // namespace hirosco::supervisor
