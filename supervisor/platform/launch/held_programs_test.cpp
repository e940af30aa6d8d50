// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/held_programs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <expected>
#include <filesystem>
#include <semaphore>
#include <string>

namespace hirosco::supervisor {
namespace {

using ::testing::HasSubstr;

/// The disk of these tests: what each name is now, how often it was read, and whether it hangs, for "arm" or for all.
struct HeldDisk {
  enum class Hangs { Nobody, Arm, All };
  std::atomic<const char*> file{"/bin/true"};
  std::atomic<int> reads{0};
  std::atomic<Hangs> hangs{Hangs::Nobody};
  std::counting_semaphore<> goes_on{0};
};
HeldDisk& held_disk() {
  static HeldDisk only;
  return only;
}

Result<ProgramImage> read_held_disk(const std::string& name) {
  const HeldDisk::Hangs hangs = held_disk().hangs;
  ++held_disk().reads;
  held_disk().reads.notify_all();
  if (hangs == HeldDisk::Hangs::All || (hangs == HeldDisk::Hangs::Arm && name == "arm")) held_disk().goes_on.acquire();
  return ProgramImage::read(held_disk().file.load());
}

struct HeldProgramsTest : ::testing::Test {
  descriptor::Mission mission = [] {
    descriptor::Mission made;
    made.file = "orbiter/mission.xml";
    made.manifest = descriptor::Manifest{"orbiter/manifest.sha256", {}};
    made.manifest->listed = {{"arm", ProgramImage::read("/bin/true").value().digest(), {}}};
    descriptor::MissionSubsystem arm;
    arm.executable = "arm";
    made.subsystems = {arm, arm};
    return made;
  }();
  HeldProgramsTest() {
    held_disk().file = "/bin/true";
    held_disk().reads = 0;
    held_disk().hangs = HeldDisk::Hangs::Nobody;
  }
  /// A further member, whose file has the same content.
  void add(const std::string& name) {
    mission.manifest->listed.push_back({name, mission.manifest->listed[0].digest, {}});
    mission.subsystems.emplace_back().executable = name;
  }
  /// Once it is read.
  static std::expected<const ProgramImage*, StartRefusal> found(HeldPrograms& programs, const std::string& name) {
    auto asked = programs.find(name);
    while (!asked && asked.error().why.code == ErrorCode::Unavailable) asked = programs.find(name);
    return asked;
  }
};

TEST_F(HeldProgramsTest, WhatTheManifestListsIsReadOnceForAllAndForTheWholeFlight) {
  HeldPrograms programs{mission, read_held_disk};
  programs.read_all(mission);
  EXPECT_EQ(programs.count(), 1U);
  held_disk().file = "/bin/false";
  const auto found = programs.find("arm");
  ASSERT_TRUE(found);
  EXPECT_EQ((*found)->digest(), mission.manifest->listed[0].digest);
  EXPECT_EQ(*programs.find("arm"), *found);
  EXPECT_EQ(held_disk().reads, 1) << "who crashed waits for no disk";
}

TEST_F(HeldProgramsTest, AnotherFileOfThatNameIsRefusedWithBothDigestsUntilTheRightOneIsBack) {
  HeldPrograms programs{mission, read_held_disk};
  held_disk().file = "/bin/false";
  programs.read_all(mission);
  EXPECT_EQ(programs.count(), 0U);
  const auto refused = programs.find("arm");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().why.code, ErrorCode::Mismatch);
  EXPECT_THAT(refused.error().words,
              HasSubstr("/bin/false has the SHA-256 " + ProgramImage::read("/bin/false")->digest()));
  EXPECT_THAT(refused.error().words, HasSubstr("the manifest says " + mission.manifest->listed[0].digest));
  EXPECT_THAT(refused.error().words, HasSubstr("hirosco manifest orbiter/mission.xml --write"));
  held_disk().file = "/bin/true";
  EXPECT_TRUE(programs.find("arm"));
}

TEST_F(HeldProgramsTest, WhatTheManifestDoesNotListIsNotEvenRead) {
  HeldPrograms programs{mission, read_held_disk};
  const auto refused = programs.find("hand");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().why.code, ErrorCode::NotFound);
  EXPECT_THAT(refused.error().words, HasSubstr("hand is not in the manifest orbiter/manifest.sha256"));
  EXPECT_EQ(held_disk().reads, 0);
}

TEST_F(HeldProgramsTest, AFileThatCannotBeReadIsRefusedWithTheReason) {
  HeldPrograms programs{mission, read_held_disk};
  held_disk().file = "/nonexistent/arm";
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::NotFound);
}

TEST_F(HeldProgramsTest, BesideAFlightThatGoesOnADiskThatHangsHoldsNobodyUpAndAllIsReadOnce) {
  held_disk().hangs = HeldDisk::Hangs::All;
  HeldPrograms programs{mission, read_held_disk};
  programs.read_all_beside(mission);
  held_disk().reads.wait(0);  // begun, though nobody has asked for it
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::Unavailable);
  held_disk().goes_on.release();
  const auto read = found(programs, "arm");
  ASSERT_TRUE(read);
  EXPECT_EQ((*read)->digest(), mission.manifest->listed[0].digest);
  EXPECT_EQ(programs.count(), 1U);
  EXPECT_EQ(held_disk().reads, 1);
}

TEST_F(HeldProgramsTest, BesideAFlightThatGoesOnAFileThatHangsKeepsNoOtherFromBeingRead) {
  add("hand");
  held_disk().hangs = HeldDisk::Hangs::Arm;
  HeldPrograms programs{mission, read_held_disk};
  programs.read_all_beside(mission);
  EXPECT_TRUE(found(programs, "hand"));
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::Unavailable);
  held_disk().goes_on.release();
  EXPECT_TRUE(found(programs, "arm"));
}

TEST_F(HeldProgramsTest, BesideAFlightThatGoesOnAnotherFileIsRefusedAsBeforeIt) {
  held_disk().file = "/bin/false";
  HeldPrograms programs{mission, read_held_disk};
  programs.read_all_beside(mission);
  const auto refused = found(programs, "arm");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().why.code, ErrorCode::Mismatch);
  held_disk().file = "/bin/true";
  EXPECT_TRUE(found(programs, "arm"));
}

TEST_F(HeldProgramsTest, ADiskThatHangsHoldsNobodyUpAndIsReadOnceItGoesOn) {
  HeldPrograms programs{mission, read_held_disk};
  held_disk().hangs = HeldDisk::Hangs::All;
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::Unavailable);
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::Unavailable);
  held_disk().goes_on.release();
  EXPECT_TRUE(found(programs, "arm"));
  EXPECT_EQ(held_disk().reads, 1) << "one thread at most waits for it";
}

/// A patience that a test would not outlast: what is waited for is seen by that.
TEST_F(HeldProgramsTest, WhileADiskHangsNobodyElseIsWaitedForHoweverManyDieAtOnce) {
  constexpr Duration very_long = std::chrono::hours{1};
  for (const char* name : {"hand", "eye", "tool"}) add(name);
  HeldPrograms programs{mission, read_held_disk};
  held_disk().hangs = HeldDisk::Hangs::All;
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::Unavailable) << "the first";
  for (const char* name : {"arm", "hand", "eye", "tool"})
    EXPECT_EQ(programs.find(name, very_long).error().why.code, ErrorCode::Unavailable) << name;
  held_disk().goes_on.release(4);
  for (const char* name : {"arm", "hand", "eye", "tool"}) EXPECT_TRUE(found(programs, name)) << name;
  EXPECT_EQ(held_disk().reads, 4);
}

}  // namespace
}  // namespace hirosco::supervisor
