// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// A stop stays until somebody who knows of it lets go: nothing that was asked for before it, and no plan, fall-back, restoration, change of mode
// or other supervisor, makes anybody move again (docs/adr/0152).
#include <gtest/gtest.h>

#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using descriptor::Mission;
using descriptor::OnLoss;
using supervisor::GuardFinding;

constexpr std::uint16_t arm_apid = 10;
const char* const arm_name = "MANIPULATOR";
const char* const partner_name = "JOYSTICK";

/// `edit` for a mission whose hand rests and whose crashed come back to at most this state.
auto crashed_come_back_to(State most) {
  return [most](Mission& mission) {
    hand_rests(mission);
    for (auto& plan : mission.plans)
      for (auto& step : plan.steps)
        if (step.kind == "restart") step.values = {1000, 60, 20, static_cast<std::int64_t>(most)};
  };
}

/// Nobody comes back, and without its partner the arm goes on alone.
void goes_on_alone(Mission& mission) {
  crashed_come_back_to(State::Offline)(mission);
  for (auto& link : mission.links) {
    if (link.to != arm_name) continue;
    link.on_loss = OnLoss::Fallback;
    link.fallback = "STANDALONE";
  }
}

struct Stopped {
  explicit Stopped(std::function<void(Mission&)> edit, std::optional<Duration> revives_after = std::nullopt)
      : flight{{.edit = std::move(edit), .revives_after = revives_after}} {}
  [[nodiscard]] bool begins() {
    const bool commissioned = flight.commission();
    flight.craft().run(300ms);
    return commissioned;
  }
  [[nodiscard]] bool may_move(const char* name = arm_name) {
    const auto* permit = flight.craft().permit(name);
    return permit != nullptr && permit->permits(permit->epoch.load()) && flight.inhibited(name) == 0;
  }
  /// At any millisecond of it.
  [[nodiscard]] bool moves_within(Duration span) {
    bool moves = false;
    for (Duration passed{0}; passed < span; passed += 1ms) {
      flight.craft().run(1ms);
      moves = moves || may_move();
    }
    return moves;
  }
  void stop_all() { flight.craft().guard().stop_all(GuardFinding::Kind::StopAsked); }
  void say(std::uint16_t apid, const char* function, std::uint8_t value) {
    auto data = call_data(function, {});
    data.back() = std::byte{1};
    data.insert(data.end(), {std::byte{1}, std::byte{value}});
    flight.craft().ground().send(function_packet(apid, ++said, data));
  }
  void say_go() { say(arm_apid, "SET_STATE", static_cast<std::uint8_t>(State::Operational)); }
  void say_mode(const char* mode) { say(1, "SET_MODE", flight.mission().find_mode(mode)->id); }
  [[nodiscard]] bool alone_and_safe() {
    if (!flight.set_mode("standalone").completed) return false;
    flight.craft().run(300ms);
    const bool safe = flight.set_state(arm_name, State::SafeOperational).completed;
    flight.craft().run(100ms);
    return safe;
  }

  Flight flight;
  std::uint16_t said{700};
};

TEST(StopsThatStay, AFenceIsNotLiftedByTheFallBackOfALostLink) {
  Stopped craft{goes_on_alone};
  ASSERT_TRUE(craft.begins());
  craft.flight.craft().guard().fence(arm_apid);
  craft.flight.craft().run(1s);
  ASSERT_EQ(craft.flight.state(arm_name), State::Operational) << "its state stays";
  craft.flight.craft().kill(partner_name);
  EXPECT_FALSE(craft.moves_within(5s)) << craft.flight.story().text();
  EXPECT_EQ(craft.flight.state(arm_name), State::SafeOperational);
}

TEST(StopsThatStay, WhoIsNotStoppedGoesOnByItsFallBack) {
  Stopped craft{goes_on_alone};
  ASSERT_TRUE(craft.begins());
  craft.flight.craft().kill(partner_name);
  craft.flight.craft().run(5s);
  EXPECT_TRUE(craft.may_move()) << craft.flight.story().text();
}

TEST(StopsThatStay, WhomAPlanHasFencedIsBroughtBackToSafeOperationalWhoeverCrashes) {
  for (const char* dies : {partner_name, arm_name}) {
    Stopped craft{[](Mission& mission) {
      crashed_come_back_to(State::Operational)(mission);
      descriptor::Plan plan;
      plan.name = "hold-still";
      plan.subsystem = arm_name;
      plan.event = "CYCLE_OVERRUNS";
      plan.steps = {{"fence", {}, {}}};
      mission.plans.push_back(plan);
    }};
    ASSERT_TRUE(craft.begins());
    craft.flight.craft().strain(arm_name, 4, 1ms);
    craft.flight.craft().run(1s);
    ASSERT_FALSE(craft.may_move()) << craft.flight.story().text();
    craft.flight.craft().kill(dies);
    EXPECT_FALSE(craft.moves_within(5s)) << dies << '\n' << craft.flight.story().text();
    EXPECT_EQ(craft.flight.state(arm_name), State::SafeOperational) << dies;
  }
}

TEST(StopsThatStay, AtEveryMomentOfAChangeOfModeAFenceAndAStopOutliveIt) {
  int fenced_in_it = 0;
  for (const bool all : {false, true})
    for (Duration after{2ms}; after < 60ms; after += 4ms) {
      Stopped craft{crashed_come_back_to(State::Offline)};
      ASSERT_TRUE(craft.begins());
      craft.say_mode("standalone");
      craft.flight.craft().run(after);
      const std::string story = craft.flight.story().text();
      if (story.find("change from mode") == std::string::npos) continue;  // it was not permitted yet
      const bool over = story.find("mode standalone\n") != std::string::npos;
      fenced_in_it += over ? 0 : 1;
      if (all) craft.stop_all();
      else craft.flight.craft().guard().fence(arm_apid);
      EXPECT_FALSE(craft.moves_within(1s)) << (all ? "a stop " : "a fence ") << after.count() << " ns after it\n"
                                           << craft.flight.story().text();
    }
  EXPECT_GE(fenced_in_it, 8);
}

TEST(StopsThatStay, WhoEntersOperationalOnTheWordOfBeforeIsTakenBack) {
  int entered = 0;
  for (Duration after{0}; after < 9ms; after += 500us) {
    Stopped craft{goes_on_alone};
    ASSERT_TRUE(craft.begins());
    ASSERT_TRUE(craft.flight.set_state(arm_name, State::SafeOperational).completed);
    craft.flight.craft().run(50ms);
    craft.say_go();
    craft.flight.craft().run(after);
    entered += craft.may_move() ? 1 : 0;
    ASSERT_TRUE(craft.flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
    craft.flight.craft().run(1s);
    EXPECT_EQ(craft.flight.state(arm_name), State::SafeOperational) << after.count() << " ns\n"
                                                                    << craft.flight.story().text();
    craft.flight.craft().kill(partner_name);
    EXPECT_FALSE(craft.moves_within(3s)) << after.count() << " ns";
  }
  EXPECT_GT(entered, 0) << "some stops came after the entry";
}

TEST(StopsThatStay, WhatWasSaidBeforeAStopAndIsReadAfterItLetsNobodyMove) {
  for (const bool mode : {false, true})
    for (const bool dies : {false, true}) {
      Stopped craft{crashed_come_back_to(State::Offline), 300ms};
      ASSERT_TRUE(craft.begins());
      ASSERT_TRUE(craft.alone_and_safe());
      craft.flight.craft().stop("SUPERVISOR", true);  // its loop stands still
      if (mode) craft.say_mode("standalone");
      else craft.say_go();
      craft.flight.craft().run(50ms);
      craft.stop_all();
      craft.flight.craft().stop("SUPERVISOR", false);
      if (dies) craft.flight.craft().kill_supervisor();
      EXPECT_FALSE(craft.moves_within(3s))
          << (mode ? "SET_MODE" : "SET_STATE") << (dies ? ", read by the next one" : "") << '\n'
          << craft.flight.story().text();
    }
}

TEST(StopsThatStay, WhatLayInTheGroundLinkLetsNobodyMoveHoweverLateItIsHandedOn) {
  for (const Duration late : {Duration{0}, Duration{1ms}, Duration{20ms}, Duration{400ms}}) {
    Stopped craft{crashed_come_back_to(State::Offline), 300ms};
    ASSERT_TRUE(craft.begins());
    ASSERT_TRUE(craft.alone_and_safe());
    if (late > Duration{0}) craft.flight.craft().stop("COMMUNICATION", true);  // its loop stands still
    craft.say_go();
    craft.stop_all();
    craft.flight.craft().run(late);
    craft.flight.craft().stop("COMMUNICATION", false);
    EXPECT_FALSE(craft.moves_within(3s)) << late.count() << " ns\n" << craft.flight.story().text();
    craft.say_go();
    EXPECT_TRUE(craft.moves_within(1s)) << "said again, it lets go";
  }
}

TEST(StopsThatStay, WhatIsSaidAfterItLetsGo) {
  for (const bool dies : {false, true}) {
    Stopped craft{crashed_come_back_to(State::Offline), 300ms};
    ASSERT_TRUE(craft.begins());
    ASSERT_TRUE(craft.alone_and_safe());
    craft.stop_all();
    if (dies) craft.flight.craft().kill_supervisor();
    craft.flight.craft().run(2s);
    EXPECT_TRUE(craft.flight.set_state(arm_name, State::Operational).completed) << craft.flight.story().text();
    craft.flight.craft().run(100ms);
    EXPECT_TRUE(craft.may_move());
  }
}

TEST(StopsThatStay, OneInTheFirstMomentsLeavesACraftThatCanBeCommanded) {
  for (const Duration after :
       {Duration{0}, Duration{1ms}, Duration{2ms}, Duration{5ms}, Duration{8ms}, Duration{20ms}, Duration{50ms}}) {
    Stopped craft{hand_rests};
    craft.flight.craft().run(after);
    craft.stop_all();
    EXPECT_FALSE(craft.moves_within(3s)) << after.count();
    EXPECT_EQ(craft.flight.craft().supervisor().own_state(), State::Operational) << after.count();
    EXPECT_TRUE(craft.flight.set_mode("telepresence").accepted) << after.count() << '\n' << craft.flight.story().text();
  }
}

}  // namespace
}  // namespace hirosco::testing
