// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "hirosco/utilities/allocation_guard.hpp"

namespace hirosco {
namespace {

TEST(AllocationGuardWithoutHook, SaysThatItDoesNotCount) {
  const RealtimeScope scope;
  const auto place = std::make_unique<int>(1);
  EXPECT_FALSE(RealtimeScope::hook_present());
  EXPECT_EQ(scope.count(), AllocationCount{});
}

}  // namespace
}  // namespace hirosco
