// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "hirosco/descriptor/testing.hpp"

/// What holds for the descriptors that the repository ships.
namespace hirosco::descriptor {
namespace {

using testing::rendered;

std::map<std::filesystem::path, Mission> shipped_missions() {
  std::map<std::filesystem::path, Mission> missions;
  for (const auto& entry : std::filesystem::directory_iterator{std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions"}) {
    const auto file = entry.path() / "mission.xml";
    if (!std::filesystem::exists(file)) continue;
    auto reading = read_mission(file, file_system());
    EXPECT_TRUE(reading.value) << rendered(reading.problems, file_system());
    if (reading.value) missions.emplace(file, std::move(*reading.value));
  }
  return missions;
}

TEST(ShippedMissions, HaveNoProblem) { EXPECT_GE(shipped_missions().size(), 2U); }

}  // namespace
}  // namespace hirosco::descriptor
