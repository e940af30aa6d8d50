// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/two_ends.hpp"

/// An encoder whose samples start the cycle of a follower, and that takes other configurations under it, in a whole spacecraft: supervisor,
/// handshake, cycles, negotiation anew.
namespace hirosco::testing {
namespace {

constexpr auto quick_encoder_text = R"(<Subsystem name="ENCODER" id="20">
  <Parameters><ParamRef name="NUMBER" id="1" type="UINT64"/><ParamRef name="ANGLE" id="2" type="DOUBLE" unit="rad"/></Parameters>
  <Configuration name="QUICK" id="1" sampling_us="2000"><RealTimeLinkService>
    <Provides name="TICK"><ParamRef name="NUMBER"/><ParamRef name="ANGLE"/></Provides></RealTimeLinkService></Configuration>
  <Configuration name="SLOW" id="2" sampling_us="4000"><RealTimeLinkService>
    <Provides name="TICK"><ParamRef name="ANGLE"/><ParamRef name="NUMBER"/></Provides></RealTimeLinkService></Configuration>
  <Configuration name="POOR" id="3" sampling_us="2000"><RealTimeLinkService>
    <Provides name="TICK"><ParamRef name="ANGLE"/></Provides></RealTimeLinkService></Configuration>
  <Configuration name="NONE" id="4" sampling_us="2000"/></Subsystem>)";

constexpr auto follower_text = R"(<Subsystem name="FOLLOWER" id="21">
  <Configuration name="FOLLOW" id="1" sampling_us="20000" started_by="TICKS" least_us="1000"><RealTimeLinkService>
    <Requires name="TICKS" age="5" missing="hold"><Field name="NUMBER" type="UINT64"/></Requires>
  </RealTimeLinkService></Configuration></Subsystem>)";

struct Follower final : Subsystem {
  struct Tick {
    std::uint64_t number;
  };
  LinkInput<Tick> ticks;
  std::vector<std::uint64_t> numbers;  ///< in each cycle
  std::vector<TimePoint> begins;

 protected:
  Result<Step> software_init() override {
    require_link("TICKS", ticks);
    return done;
  }
  Result<> pre_operational(const Cycle& cycle) noexcept override { return take(cycle); }
  Result<> safe_operational(const Cycle& cycle) noexcept override { return take(cycle); }
  Result<> operational(const Cycle& cycle) noexcept override { return take(cycle); }

 private:
  Result<> take(const Cycle& cycle) noexcept {
    numbers.push_back(ticks.value().number);
    begins.push_back(cycle.planned);
    return ok();
  }
};

struct StartedCycles : ::testing::Test {
  Encoder* encoder{nullptr};
  Follower* follower{nullptr};
  std::optional<Flight> flight;
  void begin(std::string_view on_loss = R"(on_loss="ignore")") {
    flight.emplace(two_ends({"ENCODER", "QUICK", "TICK", quick_encoder_text, making(encoder)},
                            {"FOLLOWER", "FOLLOW", "TICKS", follower_text, making(follower)}, std::string{on_loss},
                            R"(<Permit subsystem="*" functions="SET_STATE CONFIGURE"/>)"));
    ASSERT_TRUE(flight->commission()) << flight->story().text();
    ASSERT_EQ(flight->state("FOLLOWER"), State::Operational);
    forget();
  }
  void forget() {
    follower->numbers.clear();
    follower->begins.clear();
  }
  bool command(std::string_view of, std::string_view function, double argument) {
    return flight->craft().command(of, function, {Value{argument}}, 5s).completed;
  }
  /// ENCODER takes another configuration, under the follower that stays as it is.
  void take(std::uint8_t configuration) {
    for (const State state : {State::SafeOperational, State::PostOperational, State::PreOperational})
      ASSERT_TRUE(command("ENCODER", "SET_STATE", static_cast<double>(state))) << flight->story().text();
    ASSERT_TRUE(command("ENCODER", "CONFIGURE", configuration)) << flight->story().text();
    flight->craft().run(200ms);
    forget();
    flight->craft().run(400ms);
  }
};

TEST_F(StartedCycles, AreAsManyAsSamplesAndEachHasItsOwnAtOnce) {
  begin();
  flight->craft().run(1s);
  ASSERT_GE(follower->numbers.size(), 499U);
  EXPECT_LE(follower->numbers.size(), 501U);
  for (std::size_t i = 1; i < follower->numbers.size(); ++i) {
    ASSERT_EQ(follower->numbers[i], follower->numbers[i - 1] + 1) << "each sample its cycle";
    ASSERT_EQ(follower->begins[i] - follower->begins[i - 1], 2ms);
  }
  EXPECT_EQ(follower->ticks.lost(), 0U);
  EXPECT_TRUE(flight->story().has("each starts a cycle")) << flight->story().text();
}

TEST_F(StartedCycles, GoOnByTheClockWhenTheirProducerStandsStill) {
  begin();
  flight->craft().stop("ENCODER", true);
  flight->craft().run(100ms);
  const std::size_t cycles = follower->begins.size();
  EXPECT_GE(cycles, 4U);
  EXPECT_LE(cycles, 7U);
  flight->craft().stop("ENCODER", false);
  forget();
  flight->craft().run(100ms);
  EXPECT_GE(follower->begins.size(), 45U);
}

TEST_F(StartedCycles, AreOneFlightForOneSeed) {
  begin();
  flight->craft().run(300ms);
  const auto begins = follower->begins;
  flight.reset();
  begin();
  flight->craft().run(300ms);
  EXPECT_EQ(follower->begins, begins);
}

TEST_F(StartedCycles, FollowTheirProducerIntoAnotherConfiguration) {
  begin();
  take(2);
  EXPECT_TRUE(flight->story().has("250 Hz")) << flight->story().text();
  EXPECT_EQ(flight->state("FOLLOWER"), State::Operational) << "it was not restarted";
  ASSERT_GE(follower->begins.size(), 99U);
  EXPECT_EQ(follower->begins.back() - follower->begins[follower->begins.size() - 2], 4ms) << "the rate in force now";
  EXPECT_EQ(follower->numbers.back(), encoder->number.load()) << "the field is found where it stands now";
  take(1);
  EXPECT_EQ(follower->begins.back() - follower->begins[follower->begins.size() - 2], 2ms);
}

TEST_F(StartedCycles, OfAProducerWithoutTheirFieldAreRefusedByItsName) {
  begin();
  take(3);
  EXPECT_TRUE(flight->story().has("field NUMBER: consumer UINT64, producer has none")) << flight->story().text();
  EXPECT_FALSE(follower->ticks.valid());
  EXPECT_EQ(follower->begins.back() - follower->begins[follower->begins.size() - 2], 20ms) << "by the clock";
  take(1);
  EXPECT_TRUE(follower->ticks.valid()) << "what has it is joined again" << flight->story().text();
}

TEST_F(StartedCycles, OfAProducerWithoutTheirSetAreRefusedByItsName) {
  begin();
  take(4);
  EXPECT_TRUE(flight->story().has("configuration NONE of ENCODER does not provide TICK")) << flight->story().text();
  EXPECT_FALSE(follower->ticks.valid());
}

/// What the mission says of a loss counts for the time in which the producer is away, too.
TEST_F(StartedCycles, ThatAreHeldOverGoOnIfTheLinkIsMadeAnewInTime) {
  begin(R"(on_loss="hold" hold_ms="3000")");
  take(2);
  flight->craft().run(5s);
  EXPECT_EQ(flight->state("FOLLOWER"), State::Operational) << flight->story().text();
  EXPECT_TRUE(follower->ticks.valid());
}

TEST_F(StartedCycles, ThatAreHeldOverEndIfTheLinkCannotBeMadeAnew) {
  begin(R"(on_loss="hold" hold_ms="1000")");
  take(4);
  flight->craft().run(5s);
  EXPECT_NE(flight->state("FOLLOWER"), State::Operational) << flight->story().text();
}

}  // namespace
}  // namespace hirosco::testing
