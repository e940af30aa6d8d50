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

const std::filesystem::path hello = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/hello/mission.xml";

struct DescriptorReadingsTest : ::testing::Test {
  std::map<std::string, std::string> files;  ///< in place of those of this name
  std::vector<std::string> asked;
  descriptor::FileSource source = [this](const std::filesystem::path& file) -> Result<std::string> {
    asked.push_back(file.filename().string());
    const auto found = files.find(asked.back());
    return found != files.end() ? found->second : descriptor::file_system()(file);
  };
  descriptor::Mission flown = descriptor::read_mission(hello, descriptor::file_system()).value.value();
  std::filesystem::path file = flown.find_subsystem("HELLO")->subsystem.file;
  [[nodiscard]] std::string text_with(const std::string& from, const std::string& to) const {
    std::string text = *flown.find_subsystem("HELLO")->subsystem.text;
    return text.replace(text.find(from), from.size(), to);
  }
};

TEST_F(DescriptorReadingsTest, TheOtherFilesAreAsTheyWereWhenTheFlightBegan) {
  files["hello.xml"] = text_with("3.2\"", "2.5\"");
  files["mission.xml"] = files["communication.xml"] = files["supervisor.xml"] = "no descriptor any more";
  const auto reading = read_now(flown, file, source);
  ASSERT_TRUE(reading.mission.value);
  EXPECT_EQ(*reading.text, files["hello.xml"]);
  EXPECT_EQ(reading.mission.value->find_subsystem("HELLO")->subsystem.find_function("MOVE_TO")->arguments[0].field.minimum,
            Number{-2.5});
  EXPECT_THAT(asked, ::testing::ElementsAre("hello.xml"));
}

TEST_F(DescriptorReadingsTest, AllProblemsAreToldWithTheirPlaces) {
  files["hello.xml"] = text_with(R"(id="4711" interval="500")", R"(id="4711" interval="none" wrong="x")");
  const auto reading = read_now(flown, file, source);
  EXPECT_FALSE(reading.mission.value);
  ASSERT_EQ(reading.mission.problems.size(), 2U);
  for (const auto& problem : reading.mission.problems) {
    EXPECT_THAT(problem.file.string(), EndsWith("hello.xml"));
    EXPECT_GT(problem.at.line, 1);
  }
}

TEST_F(DescriptorReadingsTest, WhoUsesWhatIsGoneIsNamedInItsOwnFile) {
  files["hello.xml"] = text_with(R"(name="STAND_ALONE")", R"(name="ALONE")");
  const auto reading = read_now(flown, file, source);
  EXPECT_FALSE(reading.mission.value);
  ASSERT_FALSE(reading.mission.problems.empty());
  EXPECT_THAT(reading.mission.problems.front().file.string(), EndsWith("mission.xml"));
  EXPECT_THAT(reading.mission.problems.front().message, HasSubstr("STAND_ALONE"));
}

TEST_F(DescriptorReadingsTest, AFileThatCannotBeReadIsAProblem) {
  const auto reading = read_now(flown, "/nowhere/hello.xml", descriptor::file_system());
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
