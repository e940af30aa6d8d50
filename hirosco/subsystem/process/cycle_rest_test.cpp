// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/cycle_rest.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/word_wait.hpp"

/// What wakes a cycle's thread, with the system's own clock and a producer in another thread. Only lower limits of time: a busy machine
/// makes everything late.
namespace hirosco {
namespace {

struct CycleRest : ::testing::Test {
  const SystemClock clock;
  std::uint32_t word{0};
  CycleWait wait{.word = &word, .seen = 0, .earliest = clock.now(), .least = 1ms};
  void publish() {
    std::atomic_ref<std::uint32_t>{word}.fetch_add(1, std::memory_order_release);
    wake_on_word(word);
  }
};

TEST_F(CycleRest, EndsWithTheSampleLongBeforeItIsDue) {
  const TimePoint due = clock.now() + 1h;
  const Thread producer = *Thread::start("producer", [&] { publish(); });
  rest_until(due, wait, clock);
  EXPECT_TRUE(wait.arrived());
  EXPECT_LT(clock.now(), due);
}

TEST_F(CycleRest, WithASampleThatCameMeanwhileIsNotBegun) {
  publish();
  rest_until(clock.now() + 1h, wait, clock);
  EXPECT_TRUE(wait.arrived());
}

TEST_F(CycleRest, EndsWhenItIsDueIfNoSampleComes) {
  const TimePoint due = clock.now() + 5ms;
  rest_until(due, wait, clock);
  EXPECT_GE(clock.now(), due);
  EXPECT_FALSE(wait.arrived());
}

TEST_F(CycleRest, WithoutALinkEndsByTheClock) {
  const TimePoint due = clock.now() + 5ms;
  publish();
  rest_until(due, {}, clock);
  EXPECT_GE(clock.now(), due);
}

TEST_F(CycleRest, NeverEndsBeforeTheLeastDistance) {
  wait.earliest = clock.now() + 8ms;
  publish();
  rest_until(clock.now() + 1h, wait, clock);
  EXPECT_GE(clock.now(), wait.earliest);
  wait.earliest = clock.now() + 1h;
  const TimePoint due = clock.now() + 5ms;
  rest_until(due, wait, clock);
  EXPECT_GE(clock.now(), due) << "the longest wait holds all the same";
}

/// A producer that publishes and wakes as fast as it can costs its consumer no more cycles than the least distance allows.
TEST_F(CycleRest, AFloodCostsNoMoreWakeUpsThanTheLeastDistanceAllows) {
  std::atomic<bool> stop{false};
  const Thread producer = *Thread::start("producer", [&] {
    while (!stop.load()) publish();
  });
  constexpr int cycles = 50;
  const TimePoint began = clock.now();
  for (int cycle = 0; cycle < cycles; ++cycle) {
    wait.seen = std::atomic_ref<std::uint32_t>{word}.load();
    wait.earliest = clock.now() + wait.least;
    rest_until(clock.now() + 1h, wait, clock);
  }
  stop.store(true);
  EXPECT_GE(clock.now() - began, cycles * wait.least);
}

/// Who wakes without a sample starts no cycle, and each such wake costs the consumer one look in the least distance.
TEST_F(CycleRest, WakesWithoutASampleStartNothing) {
  std::atomic<bool> stop{false};
  const Thread producer = *Thread::start("producer", [&] {
    while (!stop.load()) wake_on_word(word);
  });
  const TimePoint due = clock.now() + 20ms;
  rest_until(due, wait, clock);
  stop.store(true);
  EXPECT_GE(clock.now(), due);
  EXPECT_FALSE(wait.arrived());
}

// --- precise cycles (adr 0104) --------------------------------------------------------------------------------------------

TEST_F(CycleRest, ThatIsPreciseEndsWhenItIsDueAndSaysWhatTheThreadHadTakenBeforeItSpun) {
  wait = {.spin = 200us};
  const Duration before = clock.processor();
  const TimePoint due = clock.now() + 3ms;
  const auto spun_from = rest_until(due, wait, clock);
  EXPECT_GE(clock.now(), due);
  ASSERT_TRUE(spun_from);
  EXPECT_GE(*spun_from, before);
  EXPECT_LE(*spun_from, clock.processor());
}

TEST_F(CycleRest, ThatIsNotPreciseSpinsNever) {
  EXPECT_FALSE(rest_until(clock.now() + 1ms, {}, clock));
  publish();
  EXPECT_FALSE(rest_until(clock.now() + 1ms, wait, clock));
}

/// Each look takes this long: so passes virtual time for who spins.
class LookedAt final : public Clock {
 public:
  LookedAt(TimePoint now, Duration look) : now_{now}, look_{look} {}
  [[nodiscard]] TimePoint passed() const { return now_; }
  [[nodiscard]] std::uint64_t looks() const { return looks_; }

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override {
    ++looks_;
    return now_ += look_;
  }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return {}; }
  mutable TimePoint now_;
  Duration look_;
  mutable std::uint64_t looks_{0};
};

TEST(Spin, LastsUntilItIsDueAndNoLookLonger) {
  for (const Duration look : {1ns, 20ns, 333ns, 5000ns})
    for (const Duration most : {1us, 50us, 200us, 1000us}) {
      const LookedAt clock{TimePoint{1s} - most, look};
      const auto looks = spin_until(TimePoint{1s}, most, clock);
      EXPECT_GE(clock.passed(), TimePoint{1s});
      EXPECT_LT(clock.passed(), TimePoint{1s} + look) << "not a look more";
      EXPECT_EQ(looks, clock.looks());
    }
}

TEST(Spin, OfWhoWakesTooLateIsOneLook) {
  const LookedAt clock{TimePoint{1s} + 10us, 20ns};
  EXPECT_EQ(spin_until(TimePoint{1s}, 200us, clock), 1U);
}

TEST(Spin, EndsWithAClockThatStandsOrGoesBack) {
  for (const Duration look : {0ns, -1000ns}) {
    const LookedAt clock{TimePoint{1s} - 50us, look};
    EXPECT_EQ(spin_until(TimePoint{1s}, 50us, clock), 50'000U) << "a look takes a nanosecond at least";
  }
}

}  // namespace
}  // namespace hirosco
