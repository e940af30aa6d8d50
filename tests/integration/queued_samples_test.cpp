// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "tests/integration/two_ends.hpp"

/// An encoder at 1 kHz of which an estimator at 100 Hz gets every sample, in a whole spacecraft: supervisor, handshake, cycles,
/// standstill, death.
namespace hirosco::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint64_t tick_depth = 64;

constexpr auto encoder_text = R"(<Subsystem name="ENCODER" id="20">
  <Parameters><ParamRef name="NUMBER" id="1" type="UINT64"/><ParamRef name="ANGLE" id="2" type="DOUBLE" unit="rad"/></Parameters>
  <Configuration name="TICKS" id="1" sampling_us="1000"><RealTimeLinkService>
    <Provides name="TICK" kind="queued"><ParamRef name="NUMBER"/><ParamRef name="ANGLE"/></Provides>
  </RealTimeLinkService></Configuration></Subsystem>)";

constexpr auto estimator_text = R"(<Subsystem name="ESTIMATOR" id="21">
  <Configuration name="TICKS" id="1" sampling_us="10000"><RealTimeLinkService>
    <Requires name="TICKS" kind="queued" depth="64" age="5"><Field name="NUMBER" type="UINT64"/><Field name="ANGLE" type="DOUBLE" unit="rad"/></Requires>
  </RealTimeLinkService></Configuration></Subsystem>)";

/// Keeps the numbers of all that came.
struct Estimator final : Subsystem {
  struct Tick {
    std::uint64_t number;
    double angle;
  };
  QueueInput<Tick> ticks;
  std::vector<std::uint64_t> numbers;
  std::size_t wrong{0};
  std::size_t most{0};  ///< in one cycle

 protected:
  Result<Step> software_init() override {
    require_link("TICKS", ticks);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return take(); }
  Result<> safe_operational(const Cycle&) noexcept override { return take(); }
  Result<> operational(const Cycle&) noexcept override { return take(); }

 private:
  Result<> take() noexcept {
    for (const Tick& tick : ticks.samples()) {
      numbers.push_back(tick.number);
      wrong += tick.angle == 0.001 * static_cast<double>(tick.number) ? 0 : 1;
    }
    most = std::max(most, ticks.samples().size());
    return ok();
  }
};

struct QueuedSamples : ::testing::Test {
  Encoder* encoder{nullptr};
  Estimator* estimator{nullptr};
  Flight flight{two_ends({"ENCODER", "TICKS", "TICK", encoder_text, making(encoder)},
                         {"ESTIMATOR", "TICKS", "TICKS", estimator_text, making(estimator)})};

  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  /// What came from here on.
  void begin() {
    estimator->numbers.clear();
    estimator->most = 0;
  }
  static std::vector<std::uint64_t> from(std::uint64_t first, std::size_t count) {
    std::vector<std::uint64_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
  }
};

TEST_F(QueuedSamples, OfAThousandEachArrivesOnceInOrder) {
  const auto& all = estimator->numbers;
  ASSERT_FALSE(all.empty());
  const std::uint64_t first = all.front(), before = all.size();
  flight.craft().run(1s);
  EXPECT_EQ(all, from(first, all.size())) << "from the first that came over the link";
  EXPECT_EQ(all.size() - before, 1'000U);
  EXPECT_EQ(estimator->wrong, 0U);
  EXPECT_EQ(estimator->ticks.lost(), 0U);
  EXPECT_EQ(estimator->ticks.received(), all.size());
  EXPECT_TRUE(estimator->ticks.valid());
  EXPECT_EQ(flight.state("ESTIMATOR"), State::Operational);
  EXPECT_EQ(flight.inhibited("ESTIMATOR"), 0U);
  EXPECT_TRUE(flight.story().has("64 samples deep")) << flight.story().text();
}

TEST_F(QueuedSamples, OfAnEstimatorThatStoodStillLongerThanItsQueueIsDeepTheLossIsExact) {
  // Not so long that the supervisor takes it for frozen.
  for (const Duration pause : {Duration{40ms}, Duration{100ms}, Duration{150ms}}) {
    flight.craft().run(50ms);
    const std::uint64_t last = estimator->numbers.back(), lost_before = estimator->ticks.lost();
    begin();
    flight.craft().stop("ESTIMATOR", true);
    flight.craft().run(pause);
    flight.craft().stop("ESTIMATOR", false);
    flight.craft().run(50ms);
    const std::uint64_t lost = estimator->ticks.lost() - lost_before;
    std::vector<std::uint64_t> gaps;
    std::uint64_t before = last;
    for (const std::uint64_t number : estimator->numbers) {
      EXPECT_GT(number, before) << "in order, none twice";
      if (number != before + 1) gaps.push_back(number - before - 1);
      before = number;
    }
    if (pause <= 64ms) EXPECT_THAT(gaps, IsEmpty());
    else EXPECT_THAT(gaps, ElementsAre(lost)) << "one gap, as long as was told";
    EXPECT_EQ(lost > 0, pause > 64ms);
    EXPECT_EQ(estimator->most == tick_depth, lost > 0) << "who lost something got all that was kept";
    EXPECT_EQ(estimator->wrong, 0U);
  }
}

TEST_F(QueuedSamples, OfAnEncoderThatDiesAllThatItFinishedArrivesAndThenTheyAreTooOld) {
  flight.craft().run(50ms);
  flight.craft().kill("ENCODER");
  encoder = nullptr;
  begin();
  flight.craft().run(200ms);
  EXPECT_LE(estimator->numbers.size(), 10U);
  EXPECT_FALSE(estimator->ticks.valid());
  EXPECT_EQ(estimator->wrong, 0U);
  EXPECT_EQ(estimator->ticks.lost(), 0U);
  EXPECT_TRUE(flight.state("ESTIMATOR") != State::Operational || flight.inhibited("ESTIMATOR") != 0);
}

}  // namespace
}  // namespace hirosco::testing
