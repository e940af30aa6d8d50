// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/thread_hold.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>

#include "hirosco/utilities/os/semaphore.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

/// A thread that gives itself a priority where it may, tells it, and waits.
struct Held {
  explicit Held(int fifo) : thread{*Thread::start("held", [this, fifo] { run(fifo); })} { began.wait(); }
  ~Held() {
    leave.post();
    thread.join();
  }
  void run(int fifo) {
    hold.enter();
    granted = fifo != 0 && set_fifo_priority(fifo).has_value();
    began.post();
    leave.wait();
    hold.leave();
    left.post();
  }
  ThreadHold hold;
  Semaphore began, leave, left;
  bool granted{false};
  Thread thread;
};

TEST(ThreadHold, TakesThePriorityOfAnotherThreadAndGivesItBack) {
  Held held{12};
  EXPECT_EQ(held.hold.has_realtime(), held.granted);
  EXPECT_TRUE(held.hold.take_realtime());
  EXPECT_FALSE(held.hold.has_realtime());
  EXPECT_TRUE(held.hold.take_realtime()) << "a second time there is nothing to take";
  held.hold.give_realtime();
  EXPECT_EQ(held.hold.has_realtime(), held.granted);
}

TEST(ThreadHold, GivesNobodyWhatHeNeverHad) {
  Held held{0};
  EXPECT_FALSE(held.hold.has_realtime());
  EXPECT_TRUE(held.hold.take_realtime());
  held.hold.give_realtime();
  EXPECT_FALSE(held.hold.has_realtime());
}

TEST(ThreadHold, CountsTheProcessorTimeOfItsThreadAndOfNoOther) {
  ThreadHold hold;
  Semaphore go, done;
  std::atomic<bool> stop{false};
  Thread thread = *Thread::start("counted", [&] {
    hold.enter();
    done.post();
    go.wait();
    while (!stop) {}
    hold.leave();
  });
  done.wait();
  const Duration before = hold.processor_time();
  go.post();
  while (hold.processor_time() - before < 5ms) {}
  stop = true;
  thread.join();
  const Duration all = hold.processor_time();
  EXPECT_GE(all - before, 5ms);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(hold.processor_time(), all) << "of one that has left no more is counted";
}

TEST(ThreadHold, OfNobodyThereIsNothingToTake) {
  ThreadHold hold;
  EXPECT_TRUE(hold.take_realtime());
  hold.give_realtime();
  EXPECT_FALSE(hold.has_realtime());
  EXPECT_EQ(hold.processor_time(), Duration{0});
}

}  // namespace
}  // namespace hirosco
