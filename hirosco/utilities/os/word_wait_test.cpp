// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/word_wait.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

void store(std::uint32_t& word, std::uint32_t value) {
  std::atomic_ref<std::uint32_t>{word}.store(value, std::memory_order_release);
}

TEST(WordWait, DoesNotWaitForAWordThatHasChangedAlready) {
  const std::uint32_t word = 2;
  EXPECT_EQ(wait_on_word(word, 1, TimePoint::max()), WordWait::Changed);
  EXPECT_EQ(wait_on_word(word, 1, TimePoint{}), WordWait::Changed) << "whatever the time";
}

TEST(WordWait, GivesUpAtItsDeadlineAndNotBefore) {
  const SystemClock clock;
  const std::uint32_t word = 1;
  const TimePoint deadline = clock.now() + 3ms;
  WordWait ended = WordWait::Woken;
  while (ended == WordWait::Woken) ended = wait_on_word(word, 1, deadline);
  EXPECT_EQ(ended, WordWait::TimedOut);
  EXPECT_GE(clock.now(), deadline);
  EXPECT_EQ(wait_on_word(word, 1, TimePoint{}), WordWait::TimedOut) << "a deadline in the past only looks";
}

TEST(WordWait, SeesWhatWasStoredBeforeTheWake) {
  const SystemClock clock;
  alignas(8) std::uint32_t there = 0;
  std::uint32_t back = 0;
  int value = 0;
  const Thread thread = *Thread::start("other", [&] {
    while (wait_on_word(there, 0, clock.now() + 10s) == WordWait::Woken) {}
    value += 1;
    store(back, 1);
    wake_on_word(back);
  });
  value = 41;
  store(there, 1);
  wake_on_word(there);
  while (wait_on_word(back, 0, clock.now() + 10s) != WordWait::Changed) {}
  EXPECT_EQ(value, 42);
}

TEST(WordWait, LosesNoChangeThatComesBetweenLookingAndSleeping) {
  constexpr std::uint32_t rounds = 20'000;
  const SystemClock clock;
  std::uint32_t there = 0, back = 0;
  const Thread thread = *Thread::start("other", [&] {
    for (std::uint32_t round = 0; round < rounds; ++round) {
      while (wait_on_word(there, round, clock.now() + 10s) != WordWait::Changed) {}
      store(back, round + 1);
      wake_on_word(back);
    }
  });
  for (std::uint32_t round = 0; round < rounds; ++round) {
    store(there, round + 1);
    wake_on_word(there);
    ASSERT_NE(wait_on_word(back, round, clock.now() + 10s), WordWait::TimedOut) << round;
    while (std::atomic_ref<std::uint32_t>{back}.load(std::memory_order_acquire) == round)
      ASSERT_NE(wait_on_word(back, round, clock.now() + 10s), WordWait::TimedOut) << round;
  }
}

}  // namespace
}  // namespace hirosco
