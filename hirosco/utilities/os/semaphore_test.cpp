// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/semaphore.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

TEST(Semaphore, LetsThroughAsManyAsWerePosted) {
  Semaphore semaphore{1};
  semaphore.post();
  EXPECT_TRUE(semaphore.try_wait());
  EXPECT_TRUE(semaphore.try_wait());
  EXPECT_FALSE(semaphore.try_wait());
}

TEST(Semaphore, WaitReturnsAfterAPostOfAnotherThread) {
  Semaphore there;
  Semaphore back;
  int value = 0;
  const Thread thread = *Thread::start("other", [&] {
    there.wait();
    value += 1;
    back.post();
  });
  value = 41;
  there.post();
  back.wait();
  EXPECT_EQ(value, 42);
}

TEST(Semaphore, GivesUpAtItsDeadlineAndNotBefore) {
  const SystemClock clock;
  Semaphore semaphore;
  const TimePoint deadline = clock.now() + 3ms;
  EXPECT_FALSE(semaphore.wait_until(deadline));
  EXPECT_GE(clock.now(), deadline);
  EXPECT_FALSE(semaphore.wait_until(TimePoint{})) << "a deadline in the past only looks";
  semaphore.post();
  EXPECT_TRUE(semaphore.wait_until(TimePoint{}));
}

TEST(Semaphore, LosesNoPostBetweenManyThreads) {
  constexpr int rounds = 5000;
  Semaphore semaphore;
  std::atomic<int> passed{0};
  {
    std::vector<Thread> threads;
    for (int i = 0; i < 2; ++i) {
      threads.push_back(*Thread::start("poster", [&] {
        for (int round = 0; round < rounds; ++round) semaphore.post();
      }));
      threads.push_back(*Thread::start("waiter", [&] {
        for (int round = 0; round < rounds; ++round) {
          semaphore.wait();
          ++passed;
        }
      }));
    }
  }
  EXPECT_EQ(passed, 2 * rounds);
  EXPECT_FALSE(semaphore.try_wait());
}

}  // namespace
}  // namespace hirosco
