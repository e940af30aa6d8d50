// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/wait_set.hpp"

#include <gtest/gtest.h>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

TEST(WaitSet, TellsWhichDescriptorIsReady) {
  auto first = WakeEvent::create();
  auto second = WakeEvent::create();
  ASSERT_TRUE(first && second);
  WaitSet set;
  ASSERT_TRUE(set.add(first->descriptor()));
  ASSERT_TRUE(set.add(second->descriptor()));
  EXPECT_TRUE(set.wait(Duration{0})->empty());
  second->notify();
  second->notify();
  const auto ready = set.wait(std::nullopt);
  ASSERT_TRUE(ready);
  ASSERT_EQ(ready->size(), 1U);
  EXPECT_EQ((*ready)[0].descriptor, second->descriptor());
  EXPECT_TRUE((*ready)[0].readable);
  EXPECT_FALSE((*ready)[0].writable || (*ready)[0].hung_up);
  second->clear();
  EXPECT_TRUE(set.wait(Duration{0})->empty());
}

TEST(WaitSet, ReturnsEmptyAtItsTimeLimitAndNotBefore) {
  const SystemClock clock;
  auto event = WakeEvent::create();
  WaitSet set;
  ASSERT_TRUE(set.add(event->descriptor()));
  const TimePoint start = clock.now();
  EXPECT_TRUE(set.wait(2500us)->empty());
  EXPECT_GE(clock.now() - start, 2500us);
}

TEST(WaitSet, IsWokenFromAnotherThread) {
  auto event = WakeEvent::create();
  WaitSet set;
  ASSERT_TRUE(set.add(event->descriptor()));
  const Thread thread = *Thread::start("waker", [&] { event->notify(); });
  EXPECT_EQ(set.wait(std::nullopt)->size(), 1U);
}

TEST(WaitSet, HoldsEachDescriptorOnce) {
  auto event = WakeEvent::create();
  WaitSet set;
  ASSERT_TRUE(set.add(event->descriptor()));
  EXPECT_EQ(set.add(event->descriptor()).error().code, ErrorCode::AlreadyExists);
  EXPECT_EQ(set.add(-1).error().code, ErrorCode::InvalidArgument);
  set.remove(event->descriptor());
  set.remove(event->descriptor());
  EXPECT_EQ(set.size(), 0U);
  EXPECT_EQ(set.change(event->descriptor(), Interest::Read).error().code, ErrorCode::NotFound);
  event->notify();
  EXPECT_TRUE(set.wait(Duration{0})->empty());
}

TEST(WaitSet, WaitsForWhatIsOfInterestOnly) {
  auto event = WakeEvent::create();
  event->notify();
  WaitSet set;
  ASSERT_TRUE(set.add(event->descriptor(), Interest::HangUpOnly));
  EXPECT_TRUE(set.wait(Duration{0})->empty());
  ASSERT_TRUE(set.change(event->descriptor(), Interest::Read));
  EXPECT_EQ(set.wait(Duration{0})->size(), 1U);
}

TEST(WakeEvent, NeverBlocksHoweverOftenItIsNotified) {
  auto event = WakeEvent::create();
  for (int i = 0; i < 100'000; ++i) event->notify();
  WaitSet set;
  ASSERT_TRUE(set.add(event->descriptor()));
  EXPECT_EQ(set.wait(Duration{0})->size(), 1U);
  event->clear();
  EXPECT_TRUE(set.wait(Duration{0})->empty());
}

TEST(FileDescriptor, ClosesWhatItOwns) {
  auto event = WakeEvent::create();
  int number = -1;
  {
    FileDescriptor borrowed{event->descriptor()};
    FileDescriptor copy = *borrowed.duplicate();
    EXPECT_EQ(borrowed.release(), event->descriptor());
    EXPECT_NE(copy.get(), event->descriptor());
    number = copy.get();
    const FileDescriptor moved = std::move(copy);
    EXPECT_EQ(moved.get(), number);
  }
  WaitSet set;
  ASSERT_TRUE(set.add(number));
  EXPECT_TRUE((*set.wait(Duration{0}))[0].hung_up) << "closed";
  EXPECT_FALSE(FileDescriptor{}.duplicate());
}

TEST(WaitReadable, WaitsForOneDescriptorWithTheResolutionOfTheClock) {
  const SystemClock clock;
  WakeEvent event = *WakeEvent::create();
  const TimePoint start = clock.now();
  EXPECT_FALSE(wait_readable(event.descriptor(), 300us));
  EXPECT_GE(clock.now() - start, 300us);
  EXPECT_FALSE(wait_readable(event.descriptor(), Duration{0}));
  EXPECT_FALSE(wait_readable(event.descriptor(), -1s));
  event.notify();
  EXPECT_TRUE(wait_readable(event.descriptor(), 1h));
  EXPECT_TRUE(wait_readable(event.descriptor(), Duration{0}));
}

}  // namespace
}  // namespace hirosco
