// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/programs_in_use.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

/// LAMP, whose executable and another version of it stand in a folder that is the first of PATH, and in a manifest there.
struct ProgramsInUseTest : ::testing::Test {
  TestFolder folder;
  std::string path_before{std::getenv("PATH")};
  descriptor::Mission mission;
  ProgramsInUse programs;

  void SetUp() override {
    ::setenv("PATH", (folder.path().string() + ":" + path_before).c_str(), 1);
    std::filesystem::copy_file("/bin/true", own());
    std::filesystem::copy_file("/bin/false", own().string() + "@2");
    auto& lamp = mission.subsystems.emplace_back();
    lamp.subsystem.name = "LAMP";
    lamp.executable = own().filename().string();
    mission.manifest = descriptor::Manifest{folder.path() / "manifest.sha256", {}};
    std::ofstream manifest{mission.manifest->file};
    for (const auto& name : {lamp.executable, lamp.executable + "@2"}) {
      const std::string digest = ProgramImage::read(folder.path() / name).value().digest();
      mission.manifest->listed.push_back({name, digest, {}});
      manifest << digest << "  " << name << '\n';
    }
  }
  ~ProgramsInUseTest() override { ::setenv("PATH", path_before.c_str(), 1); }
  [[nodiscard]] std::filesystem::path own() const { return folder.path() / "hirosco-test-lamp"; }
  [[nodiscard]] const descriptor::MissionSubsystem& lamp() const { return mission.subsystems[0]; }
  /// When the disk has said what it is.
  [[nodiscard]] Result<ProgramsInUse::Found> found() {
    for (;;)
      if (auto what = programs.find(lamp()); what || what.error().code != ErrorCode::Unavailable) return what;
  }
};

TEST_F(ProgramsInUseTest, WithoutAManifestItIsTheFileOfThatNameWhereItWasFoundFirst) {
  const auto found = programs.find(lamp());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->file.filename(), own().filename());
  EXPECT_EQ(found->image, nullptr);
  EXPECT_FALSE(found->interpreter);
  EXPECT_FALSE(programs.refuse(lamp()));
  std::filesystem::remove(own());
  EXPECT_EQ(programs.find(lamp())->file, found->file) << "the disk is not asked again";
  programs.look_again(lamp());
  EXPECT_EQ(programs.find(lamp()).error().code, ErrorCode::NotFound);
}

TEST_F(ProgramsInUseTest, WithAManifestItIsWhatWasReadBeforeTheFlight) {
  EXPECT_EQ(programs.hold_to(mission).count(), 1U);
  std::filesystem::remove(own());
  const auto found = programs.find(lamp());
  ASSERT_TRUE(found);
  ASSERT_NE(found->image, nullptr);
  EXPECT_EQ(found->image->digest(), mission.manifest->listed[0].digest);
}

TEST_F(ProgramsInUseTest, AScriptIsWhatWasReadBeforeTheFlightTooAndAnotherOneIsRefused) {
  const auto write = [&](const char* text) {
    std::ofstream{own()} << text;
    std::filesystem::permissions(own(), std::filesystem::perms::owner_all);
  };
  std::filesystem::remove(own());
  write("#!/bin/sh\nexit 7\n");
  EXPECT_TRUE(programs.find(lamp())->interpreter);
  mission.manifest->listed[0].digest = ProgramImage::read(own())->digest();
  programs.hold_to(mission);
  write("#!/bin/sh\nexit 8\n");
  const auto held = found();
  ASSERT_TRUE(held);
  EXPECT_EQ(held->image->digest(), mission.manifest->listed[0].digest);
  ASSERT_TRUE(held->interpreter);
  EXPECT_TRUE(held->interpreter->listable.empty()) << "it runs from memory, where nothing stands beside it";
  programs.hold_to(mission);
  EXPECT_EQ(found().error().code, ErrorCode::Mismatch);
}

TEST_F(ProgramsInUseTest, BesideAFlightItIsTheSameAsSoonAsItHasBeenRead) {
  programs.hold_to_beside(mission);
  EXPECT_TRUE(programs.has_manifest());
  const auto what = found();
  ASSERT_TRUE(what);
  EXPECT_EQ(what->image->digest(), mission.manifest->listed[0].digest);
  std::filesystem::remove(own());
  EXPECT_TRUE(programs.find(lamp())) << "the disk is not asked again";
}

TEST_F(ProgramsInUseTest, WhatTheManifestDoesNotHaveThatWayIsRefused) {
  std::filesystem::copy_file("/bin/false", own(), std::filesystem::copy_options::overwrite_existing);
  programs.hold_to(mission);
  EXPECT_EQ(found().error().code, ErrorCode::Mismatch);
  EXPECT_TRUE(programs.refuse(lamp()));
}

TEST_F(ProgramsInUseTest, AnotherVersionIsInUseUntilTheMissionsOwnIs) {
  programs.hold_to(mission);
  const auto digest = [&] { return found()->image->digest(); };
  programs.use(lamp(), "2");
  EXPECT_EQ(digest(), mission.manifest->listed[1].digest);
  EXPECT_TRUE(programs.prepare(lamp(), "2").value()) << "it is there";
  programs.use(lamp(), "");
  EXPECT_EQ(digest(), mission.manifest->listed[0].digest);
}

}  // namespace
}  // namespace hirosco::supervisor
