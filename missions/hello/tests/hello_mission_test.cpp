// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::descriptor {
namespace {

/// It is taught from, where somebody tries it first (docs/adr/0095).
TEST(HelloMission, PermitsToReadADescriptorAgainInItsInitialMode) {
  const auto reading =
      read_mission(std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/hello/mission.xml", file_system());
  ASSERT_TRUE(reading.value);
  const Mode& initial = *reading.value->find_mode(reading.value->initial_mode);
  EXPECT_TRUE(std::ranges::any_of(initial.permits, [](const Permit& permit) {
    return std::ranges::find(permit.functions, "REREAD") != permit.functions.end();
  }));
}

}  // namespace
}  // namespace hirosco::descriptor
