// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/thread.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <barrier>
#include <csignal>
#include <memory>
#include <vector>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/mutex.hpp"

namespace hirosco {
namespace {

TEST(Thread, RunsItsBodyAndIsJoined) {
  int value = 0;
  Thread thread = *Thread::start("body", [&, owned = std::make_unique<int>(7)] { value = *owned; });
  EXPECT_TRUE(thread.joinable());
  thread.join();
  EXPECT_EQ(value, 7);
  EXPECT_FALSE(thread.joinable());
  thread.join();
}

TEST(Thread, IsJoinedByDestructorAndByMoveAssignment) {
  std::atomic<int> ended{0};
  {
    Thread thread = *Thread::start("first", [&] { ++ended; });
    thread = *Thread::start("second", [&] { ++ended; }, 256 * 1024);
    EXPECT_GE(ended, 1);
    const Thread moved = std::move(thread);
    EXPECT_TRUE(moved.joinable());
  }
  EXPECT_EQ(ended, 2);
}

TEST(SleepUntil, WakesAtItsTimeAndNotBefore) {
  const SystemClock clock;
  const TimePoint start = clock.now();
  for (const Duration span : {2ms, 1ms, 3ms}) {
    const TimePoint wake = clock.now() + span;
    sleep_until(wake);
    EXPECT_GE(clock.now(), wake);
  }
  EXPECT_GE(clock.now() - start, 6ms);
  sleep_until(start);
  sleep_until(TimePoint{-1s});
}

TEST(SleepUntil, WakesEachSleeperAtItsOwnDeadline) {
  const SystemClock clock;
  std::array<TimePoint, 3> woke{};
  const TimePoint start = clock.now() + 5ms;
  {
    std::vector<Thread> threads;
    for (const std::size_t place : {2U, 0U, 1U})
      threads.push_back(*Thread::start("sleeper", [&, place] {
        sleep_until(start + static_cast<int>(place) * 40ms);
        woke.at(place) = clock.now();
      }));
  }
  for (std::size_t place = 0; place < woke.size(); ++place)
    EXPECT_GE(woke.at(place), start + static_cast<int>(place) * 40ms) << place;
}

TEST(SleepUntil, IsNotShortenedBySignals) {
  struct sigaction action{};
  action.sa_handler = [](int) {};
  ASSERT_EQ(::sigaction(SIGUSR1, &action, nullptr), 0);
  const SystemClock clock;
  std::atomic<bool> awake{false};
  std::atomic<bool> started{false};
  pthread_t sleeper{};
  TimePoint woke;
  const TimePoint wake = clock.now() + 30ms;
  Thread thread = *Thread::start("sleeper", [&] {
    sleeper = pthread_self();
    started = true;
    sleep_until(wake);
    woke = clock.now();
    awake = true;
  });
  while (!started) sched_yield();
  while (!awake) {
    (void)pthread_kill(sleeper, SIGUSR1);
    sched_yield();
  }
  thread.join();
  EXPECT_GE(woke, wake);
}

TEST(Scheduling, RefusesAPriorityThatDoesNotExist) {
  EXPECT_EQ(set_fifo_priority(0).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(set_fifo_priority(1000).error().code, ErrorCode::OutOfRange);
}

struct Rank {
  int policy{};
  int priority{};
};
/// Of the calling thread, as the system has it. musl refuses the first, which on Linux is of a thread and by POSIX of a process; other C
/// libraries answer the second by what it was when they were asked first.
Rank own_rank() {
  sched_param parameters{};
  int policy = sched_getscheduler(0);
  if (policy >= 0) static_cast<void>(sched_getparam(0, &parameters));
  else static_cast<void>(pthread_getschedparam(pthread_self(), &policy, &parameters));
  return {policy & ~SCHED_RESET_ON_FORK, parameters.sched_priority};
}

TEST(Scheduling, ASharedPriorityIsRoundRobinAndTheProbeLeavesIt) {
  EXPECT_EQ(set_shared_priority(0).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(set_shared_priority(1000).error().code, ErrorCode::OutOfRange);
  Thread::start("sharer", [] {
    if (!realtime_permitted()) return;
    ASSERT_TRUE(set_shared_priority(10));
    EXPECT_EQ(own_rank().priority, 10);
    EXPECT_EQ(own_rank().policy, SCHED_RR);
    EXPECT_TRUE(realtime_permitted());
    EXPECT_EQ(own_rank().policy, SCHED_RR) << "the probe leaves it as it is";
    EXPECT_TRUE(set_ordinary_scheduling());
    EXPECT_EQ(own_rank().policy, SCHED_OTHER);
  })->join();
}

TEST(Scheduling, OneThatNeverRestsLeavesOthersOfASharedPriorityTheirTurn) {
  std::array<std::atomic<std::uint64_t>, 2> turns{};
  std::array<bool, 2> got{};
  std::barrier both{2};
  const auto spins = [&](std::size_t own) {
    const bool shares = set_shared_priority(1) && pin_to_cycle_cpu();
    both.arrive_and_wait();
    got.at(own) = !shares;  // without the right to it there is nothing to see
    if (!shares) return;
    constexpr std::uint64_t most = 2'000'000'000;  // a thread that gets no turn at all fails, it does not hang
    ++turns.at(own);
    for (std::uint64_t i = 0; i < most && turns.at(1 - own) == 0; ++i) ++turns.at(own);
    got.at(own) = turns.at(1 - own) != 0;
  };
  {
    const Thread first = *Thread::start("first", [&] { spins(0); });
    const Thread second = *Thread::start("second", [&] { spins(1); });
  }
  EXPECT_TRUE(got[0] && got[1]);
}

TEST(Scheduling, WhoWasPinnedGoesBackToTheProcessorsThatItCouldUse) {
  Thread::start("pinned", [] {
    const unsigned could_use = usable_processors();
    const ProcessorSet before = ProcessorSet::of_this_thread();
    const auto pinned = pin_to_cycle_cpu();
    EXPECT_TRUE(pinned || pinned.error().code == ErrorCode::Unavailable) << "a backend without affinity says so";
    EXPECT_EQ(usable_processors(), 1U);
    EXPECT_EQ(before.take().has_value(), pinned.has_value());
    EXPECT_EQ(usable_processors(), could_use);
    EXPECT_EQ(ProcessorSet{}.take().error().code, ErrorCode::Unavailable) << "nobody was asked";
  })->join();
}

TEST(Scheduling, ShortSlicesNeedNoRightAndChangeNoPolicy) {
  Thread::start("modest", [] {
    const auto asked = ask_for_short_slices();
    EXPECT_TRUE(asked || asked.error().code == ErrorCode::Unavailable) << "a backend without slices says so";
    EXPECT_EQ(own_rank().policy, SCHED_OTHER);
  })->join();
}

TEST(Scheduling, ProbeAgreesWithTheAttempt) {
  Thread::start("prober", [] {
    const bool permitted = realtime_permitted();
    EXPECT_EQ(own_rank().policy, SCHED_OTHER) << "the probe undoes what it tried";
    EXPECT_EQ(set_fifo_priority(10).has_value(), permitted);
    if (!permitted) return;
    EXPECT_TRUE(realtime_permitted());
    EXPECT_EQ(own_rank().policy, SCHED_FIFO) << "the probe leaves a FIFO thread as it is";
    EXPECT_EQ(own_rank().priority, 10);
    EXPECT_TRUE(set_ordinary_scheduling());
    EXPECT_EQ(own_rank().policy, SCHED_OTHER);
  })->join();
}

}  // namespace
}  // namespace hirosco
