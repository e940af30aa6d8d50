// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

TEST(AFlightsFolder, TellsItsInstanceAgainAndNobodyElsesDoes) {
  EXPECT_EQ(instance_of_folder(runtime_folder("night")), "night");
  EXPECT_EQ(instance_of_folder("/somewhere/else"), "");
  EXPECT_EQ(instance_of_folder(runtime_folder("night").parent_path() / "night"), "");
}

TEST(AnArchive, StandsBesideItsLogWhateverEitherIsCalled) {
  EXPECT_EQ(archive_beside("log/orbiter.db"), "log/orbiter-ground.db");
  EXPECT_EQ(archive_beside("log/orbiter.2.db"), "log/orbiter.2-ground.db");
  EXPECT_EQ(archive_beside("orbiter"), "orbiter-ground.db");
}

TEST(AWrongName, IsAnsweredByTheNearestAndByNoneThatIsFar) {
  EXPECT_EQ(did_you_mean("obiter", {"hello", "orbiter"}), "; did you mean 'orbiter'?");
  EXPECT_EQ(did_you_mean("zzzzzzzz", {"hello", "orbiter"}), "");
  EXPECT_EQ(did_you_mean("hello", {}), "");
}

}  // namespace
}  // namespace hirosco::tools
