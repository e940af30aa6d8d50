// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/held_programs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <semaphore>
#include <string>

namespace hirosco::supervisor {
namespace {

using ::testing::HasSubstr;

/// The disk of these tests: what each name is now, how often it was read, and whether it hangs.
struct HeldDisk {
  std::atomic<const char*> file{"/bin/true"};
  std::atomic<int> reads{0};
  std::atomic<bool> hangs{false};
  std::binary_semaphore goes_on{0};
};
HeldDisk& held_disk() {
  static HeldDisk only;
  return only;
}

Result<ProgramImage> read_held_disk(const std::string&) {
  ++held_disk().reads;
  if (held_disk().hangs) held_disk().goes_on.acquire();
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
    held_disk().hangs = false;
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
  held_disk().hangs = true;
  HeldPrograms programs{mission, read_held_disk};
  programs.read_all_beside(mission);
  EXPECT_EQ(programs.count(), 0U);
  EXPECT_EQ(programs.find("arm", Duration{0}).error().why.code, ErrorCode::Unavailable);
  held_disk().goes_on.release();
  while (!programs.find("arm")) {}
  EXPECT_EQ(held_disk().reads, 1);
  EXPECT_EQ((*programs.find("arm"))->digest(), mission.manifest->listed[0].digest);
}

TEST_F(HeldProgramsTest, BesideAFlightThatGoesOnAnotherFileIsRefusedAsBeforeIt) {
  held_disk().file = "/bin/false";
  HeldPrograms programs{mission, read_held_disk};
  programs.read_all_beside(mission);
  const auto refused = programs.find("arm", std::chrono::hours{1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().why.code, ErrorCode::Mismatch);
  held_disk().file = "/bin/true";
  EXPECT_TRUE(programs.find("arm", std::chrono::hours{1}));
}

TEST_F(HeldProgramsTest, ADiskThatHangsHoldsNobodyUpAndIsReadOnceItGoesOn) {
  HeldPrograms programs{mission, read_held_disk};
  held_disk().hangs = true;
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::Unavailable);
  EXPECT_EQ(programs.find("arm").error().why.code, ErrorCode::Unavailable);
  EXPECT_EQ(held_disk().reads, 1) << "one thread at most waits for it";
  held_disk().hangs = false;
  held_disk().goes_on.release();
  while (!programs.find("arm")) {}
  EXPECT_EQ(held_disk().reads, 1);
}

}  // namespace
}  // namespace hirosco::supervisor
