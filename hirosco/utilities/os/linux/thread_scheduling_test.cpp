// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sched.h>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

TEST(LinuxScheduling, WhoHasRealTimePassesNoneOn) {
  for (const auto set : {set_fifo_priority, set_shared_priority}) {
    Thread::start("parent", [set] {
      if (!realtime_permitted()) return;
      ASSERT_TRUE(set(10));
      Thread::start("child", [] { EXPECT_EQ(sched_getscheduler(0) & ~SCHED_RESET_ON_FORK, SCHED_OTHER); })->join();
    })->join();
  }
}

}  // namespace
}  // namespace hirosco
