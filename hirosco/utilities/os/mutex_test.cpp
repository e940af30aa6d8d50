// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/mutex.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

TEST(Mutex, InheritsPriority) {
  const Mutex mutex;
  EXPECT_TRUE(mutex.inherits_priority());
}

TEST(Mutex, ExcludesOtherThreads) {
  constexpr int rounds = 20'000;
  Mutex mutex;
  long counter = 0;
  {
    std::vector<Thread> threads;
    for (int i = 0; i < 4; ++i)
      threads.push_back(*Thread::start("worker", [&] {
        for (int round = 0; round < rounds; ++round) {
          const LockGuard guard{mutex};
          counter = counter + 1;
        }
      }));
  }
  EXPECT_EQ(counter, 4 * rounds);
}

TEST(Mutex, TryLockFailsWhileAnotherThreadHoldsIt) {
  Mutex mutex;
  std::optional<bool> got;
  const auto attempt = [&] {
    Thread::start("other", [&] {
      got = mutex.try_lock();
      if (*got) mutex.unlock();
    })->join();
    return *got;
  };
  {
    const LockGuard guard{mutex};
    EXPECT_FALSE(attempt());
  }
  EXPECT_TRUE(attempt());
}

TEST(MutexDeathTest, StopsAtAnUnlockByWhoDoesNotHoldIt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        Mutex mutex;
        mutex.unlock();
      },
      "");
}

}  // namespace
}  // namespace hirosco
