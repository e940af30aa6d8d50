// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>
#include <vector>

#include "hirosco/utilities/testing/slice.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "tests/integration/flight.hpp"

/// What the loss of the joystick's set does to the robot is what the mission says of its link (docs/adr/0077).
namespace hirosco::testing {
namespace {

using descriptor::MissingPolicy;
using descriptor::OnLoss;

constexpr std::uint8_t into_robot = 2;
constexpr std::uint8_t coupled = 2;

struct Loss {
  OnLoss on_loss{OnLoss::Down};
  Duration hold{};
  std::string fallback{};
  State comes_back{State::Offline};
};

[[nodiscard]] std::function<void(descriptor::Mission&)> with(const Loss& loss) {
  return [=](descriptor::Mission& mission) {
    simulation::hand_rests(mission);
    for (auto& link : mission.links) {
      if (link.id != into_robot) continue;
      link.on_loss = loss.on_loss;
      link.hold = loss.hold;
      link.fallback = loss.fallback;
    }
    const bool goes_on = loss.on_loss == OnLoss::Hold || loss.on_loss == OnLoss::Ignore;
    for (auto& member : mission.subsystems)
      for (auto& configuration : member.subsystem.configurations)
        for (auto& wanted : configuration.requires_)
          if (goes_on && member.subsystem.name == "MANIPULATOR") wanted.missing = MissingPolicy::Hold;
    for (auto& plan : mission.plans)
      for (auto& step : plan.steps)
        if (step.kind == "restart") step.values = {1000, 60, 20, static_cast<std::int64_t>(loss.comes_back)};
  };
}

struct LossFlight {
  explicit LossFlight(const Loss& loss) : flight{{.edit = with(loss)}} {
    if (!flight.commission()) throw std::runtime_error{flight.story().text()};
  }
  [[nodiscard]] bool robot_may_move() {
    const auto* page = flight.craft().permit("MANIPULATOR");
    return page != nullptr && page->permits(page->epoch.load()) && flight.inhibited("MANIPULATOR") == 0;
  }
  [[nodiscard]] State robot() { return flight.state("MANIPULATOR"); }
  [[nodiscard]] int configuration() {
    return static_cast<int>(flight.craft().vital("MANIPULATOR")->configuration.load(std::memory_order_relaxed));
  }
  Flight flight;
};

TEST(LinkLosses, WhatIsHeldOverGoesOnForItsTimeAndThenDown) {
  LossFlight flown{{.on_loss = OnLoss::Hold, .hold = 700ms}};
  flown.flight.craft().kill("JOYSTICK");
  flown.flight.craft().run(600ms);
  EXPECT_EQ(flown.robot(), State::Operational) << flown.flight.story().text();
  EXPECT_TRUE(flown.robot_may_move());
  EXPECT_TRUE(flown.flight.story().has("MANIPULATOR has lost JOYSTICK_STATE of JOYSTICK: hold"));
  EXPECT_TRUE(flown.flight.story().has("SUPERVISOR low LINK_LOST LINK=2 APID=10"));
  flown.flight.craft().run(150ms);
  EXPECT_FALSE(flown.robot_may_move());
  EXPECT_TRUE(flown.flight.run_until_state("MANIPULATOR", State::Offline, 2s)) << flown.flight.story().text();
}

TEST(LinkLosses, WhatComesBackInItsTimeIsAsIfNothingHadHappened) {
  LossFlight flown{{.on_loss = OnLoss::Hold, .hold = 5s, .comes_back = State::Operational}};
  for (int time = 1; time <= 3; ++time) {
    flown.flight.craft().kill("JOYSTICK");
    flown.flight.craft().run(8s);
    EXPECT_EQ(flown.flight.state("JOYSTICK"), State::Operational) << flown.flight.story().text();
    EXPECT_EQ(flown.flight.craft().supervisor().links().up_count(), 2U) << time;
    EXPECT_EQ(flown.robot(), State::Operational);
    EXPECT_TRUE(flown.robot_may_move());
  }
  EXPECT_FALSE(flown.flight.story().has("MANIPULATOR info STATE_CHANGED STATE=ErrorOperational"));
}

TEST(LinkLosses, WhatIsIgnoredTakesNobodyDown) {
  LossFlight flown{{.on_loss = OnLoss::Ignore}};
  flown.flight.craft().kill("JOYSTICK");
  flown.flight.craft().run(10s);
  EXPECT_EQ(flown.robot(), State::Operational) << flown.flight.story().text();
  EXPECT_EQ(flown.configuration(), coupled);
  EXPECT_TRUE(flown.robot_may_move());
  EXPECT_TRUE(flown.flight.story().has("MANIPULATOR has lost JOYSTICK_STATE of JOYSTICK: ignore"));
}

TEST(LinkLosses, WhoFallsBackNeverActsWithWhatIsLost) {
  LossFlight flown{{.on_loss = OnLoss::Fallback, .fallback = "STANDALONE"}};
  flown.flight.craft().kill("JOYSTICK");
  bool acted = false;
  for (int step = 0; step < 3000; ++step) {
    flown.flight.craft().run(1ms);
    // Three of its cycles are the age limit; the supervisor sees the death a step later.
    if (step >= 12 && flown.configuration() == coupled && flown.robot_may_move()) acted = true;
  }
  EXPECT_FALSE(acted);
  EXPECT_EQ(flown.robot(), State::Operational) << flown.flight.story().text();
  EXPECT_EQ(flown.configuration(), 1);
  EXPECT_TRUE(flown.robot_may_move());
  EXPECT_TRUE(flown.flight.story().has("MANIPULATOR goes on in configuration STANDALONE"));
}

TEST(LinkLosses, AStopEndsWhatGoesOnHoweverItDoes) {
  const std::vector<Duration> moments =
      whole() ? std::vector<Duration>{1ms, 20ms, 40ms, 60ms, 80ms, 100ms, 150ms} : std::vector<Duration>{1ms, 60ms};
  for (const Loss& loss : {Loss{.on_loss = OnLoss::Hold, .hold = 5s}, Loss{.on_loss = OnLoss::Ignore},
                           Loss{.on_loss = OnLoss::Fallback, .fallback = "STANDALONE"}})
    for (const Duration after : moments) {
      LossFlight flown{loss};
      flown.flight.craft().kill("JOYSTICK");
      flown.flight.craft().run(after);
      static_cast<void>(flown.flight.craft().command("SUPERVISOR", "SAFE_ALL", {}));
      flown.flight.craft().run(3s);
      EXPECT_NE(flown.robot(), State::Operational) << to_text(loss.on_loss) << " " << after / 1ms;
      EXPECT_FALSE(flown.robot_may_move()) << to_text(loss.on_loss) << " " << after / 1ms;
    }
}

/// A change to a mode in which it needs no set goes on, and so does one to where it is joined to the joystick again: that makes the link anew.
/// The supervisor sees in every tenth millisecond that the time is over.
TEST(LinkLosses, WhatIsHeldOverEndsNoChangeThatLeadsItsConsumerElsewhereWheneverItsTimeIsOver) {
  constexpr Duration hold = 700ms, watched_each = 10ms;
  for (const char* mode : {"standalone", "feel"}) {
    int within = 0;
    for (Duration before = -watched_each; before < 40ms; before += one_in(3) * 1ms) {
      SCOPED_TRACE(std::string{mode} + " " + std::to_string(before / 1ms));
      LossFlight flown{{.on_loss = OnLoss::Hold, .hold = hold, .comes_back = State::PreOperational}};
      Flight& flight = flown.flight;
      std::optional<TimePoint> lost_at;
      bool acted_on = false;
      flight.story().on_line = [&](std::string_view line) {
        if (line.starts_with("MANIPULATOR has lost")) lost_at = flight.craft().now();
      };
      flight.craft().on_cycle([&](std::string_view name, TimePoint now) {
        const bool over = lost_at && now > *lost_at + hold + 2 * watched_each;
        const bool acts = flown.robot() == State::Operational && flown.robot_may_move();
        if (over && name == "MANIPULATOR" && flown.configuration() == coupled && acts) acted_on = true;
      });
      flight.craft().kill("JOYSTICK");
      ASSERT_TRUE(flight.craft().run_until([&] { return lost_at.has_value(); }, 1s)) << flight.story().text();
      const TimePoint until = *lost_at + hold;
      flight.craft().run(until - before - flight.craft().now());
      if (flight.story().has("did not come back in time")) continue;  // that was seen before
      EXPECT_EQ(flown.robot(), State::Operational);
      EXPECT_TRUE(flight.set_mode(mode).completed) << flight.story().text();
      EXPECT_FALSE(acted_on) << flight.story().text();
      within += flight.craft().now() > until + watched_each ? 1 : 0;
      flight.craft().run(1s);
      EXPECT_EQ(flight.craft().supervisor().mode().name, mode);
      EXPECT_EQ(flown.robot(), State::Operational) << flight.story().text();
      EXPECT_TRUE(flown.robot_may_move()) << flight.story().text();
      if (::testing::Test::HasFailure()) return;
    }
    EXPECT_GT(within, 3);
  }
}

TEST(LinkLosses, AProducerThatLeavesInGoodOrderIsMissedToo) {
  LossFlight flown{{.on_loss = OnLoss::Hold, .hold = 700ms}};
  ASSERT_TRUE(flown.flight.set_state("JOYSTICK", State::SafeOperational).completed);
  ASSERT_TRUE(flown.flight.set_state("JOYSTICK", State::Offline).completed);
  EXPECT_EQ(flown.robot(), State::Operational) << flown.flight.story().text();
  flown.flight.craft().run(2s);
  EXPECT_EQ(flown.robot(), State::Offline) << flown.flight.story().text();
}

TEST(LinkLosses, WhoSaysNothingOfItGoesDownAsEver) {
  LossFlight flown{{}};
  flown.flight.craft().kill("JOYSTICK");
  flown.flight.craft().run(2s);
  EXPECT_EQ(flown.robot(), State::Offline);
}

TEST(LinkLosses, AProducerThatStandsIsALossToo) {
  LossFlight flown{{.on_loss = OnLoss::Fallback, .fallback = "STANDALONE"}};
  flown.flight.craft().stop("JOYSTICK", true);
  flown.flight.craft().run(4s);
  EXPECT_EQ(flown.robot(), State::Operational) << flown.flight.story().text();
  EXPECT_EQ(flown.configuration(), 1);
}

}  // namespace
}  // namespace hirosco::testing
