// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/self_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace hirosco::joystick {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// A handle that nobody holds, coupled to a robot that does not act.
SelfCheck::Seen at_rest() { return {.alive = true, .hand = 0, .hands = 1, .force_scale = 0.02, .period_s = 0.0005}; }

/// "passed after 6", or why not; `change` spoils what is seen from this cycle on, counted from 0.
template <class Change>
std::string said(Change change, int from = 0, Law law = display_law) {
  SelfCheck check{law};
  SelfCheck::Seen seen = at_rest();
  for (int cycle = 0; cycle < 100; ++cycle) {
    if (cycle >= from) change(seen);
    const auto step = check.step(seen, cycle == 0);
    if (!step) return step.error().text + (" " + std::to_string(step.error().value));
    if (*step == Step::Done) return "passed after " + std::to_string(cycle + 1);
  }
  return "no end";
}
std::string said_of(Law law) {
  return said([](SelfCheck::Seen&) {}, 0, law);
}

TEST(JoystickSelfCheck, PassesWithinSixCyclesAlsoWhileAHandMovesTheStickAndTheRobotPresses) {
  EXPECT_EQ(said([](SelfCheck::Seen&) {}), "passed after 6");
  EXPECT_EQ(said([](SelfCheck::Seen& seen) {
              seen.velocity_rad_s = {3.0, -3.0};
              seen.position_rad[0] += 0.0015;
              seen.position_rad[1] -= 0.0015;
            }),
            "passed after 6");
  EXPECT_EQ(said([](SelfCheck::Seen& seen) {
              seen.peer_active = true;
              seen.shown_n_m = {0.2, -0.1};
            }),
            "passed after 6");
  EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.position_rad = {0.54, -0.54}; }), "passed after 6")
      << "the rubber of a stop gives way to who leans on it";
  for (const double scale : {0.0, 1e-4, 0.1})
    EXPECT_EQ(said([scale](SelfCheck::Seen& seen) { seen.force_scale = scale; }), "passed after 6") << scale;
  for (const double period_s : {1e-4, 0.1})
    EXPECT_EQ(said([period_s](SelfCheck::Seen& seen) { seen.period_s = period_s; }), "passed after 6") << period_s;
}

TEST(JoystickSelfCheck, FindsAHandleThatCannotBeRight) {
  for (const int from : {0, 3}) {
    EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.alive = false; }, from), "the handle says nothing 0");
    EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.velocity_rad_s[1] = 25; }, from),
              "measured faster than a hand is, axis 2");
    EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.velocity_rad_s[0] = no_number; }, from),
              "measured faster than a hand is, axis 1");
    EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.position_rad[1] = 0.56; }, from),
              "measured outside of its range, axis 2");
    EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.position_rad[0] = no_number; }, from),
              "measured outside of its range, axis 1");
    EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.hand = 2; }, from), "it tells of a hand that it has not, number 2");
    EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.hand = 200; }, from),
              "it tells of a hand that it has not, number 200");
  }
  EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.position_rad[1] = 0.1; }, 2), "measured to jump, axis 2");
}

TEST(JoystickSelfCheck, FindsATorqueThatNobodyPressesFor) {
  EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.shown_n_m = {0, 0.01}; }),
            "it would push though no robot presses, axis 2");
  EXPECT_EQ(said([](SelfCheck::Seen& seen) { seen.shown_n_m = {no_number, 0}; }),
            "it would push though no robot presses, axis 1");
}

TEST(JoystickSelfCheck, LetsATorqueFadeThatWasShownWhenItBegan) {
  double left = 0.2;
  EXPECT_EQ(said([&](SelfCheck::Seen& seen) {
              left = std::max(left - 0.05, 0.0);
              seen.shown_n_m[0] = left;
            }),
            "passed after 6");
}

/// What a slip of the pen makes of the law.
TEST(JoystickSelfCheck, FindsALawThatIsWrong) {
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              for (double& each : torque) each = -each;
              return torque;
            }),
            "it would not push against what the robot presses on, axis 1");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              torque[1] = -torque[1];
              return torque;
            }),
            "it would not push against what the robot presses on, axis 2");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              return law.torque(input, 10 * scale);
            }),
            "it would not push against what the robot presses on, axis 1");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              std::swap(torque[0], torque[1]);
              return torque;
            }),
            "it would not push against what the robot presses on, axis 1");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              torque[1] += 0.1 * torque[0];
              return torque;
            }),
            "it would push by the other axis, axis 2");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              torque[0] += 0.05;
              return torque;
            }),
            "it would push though the robot presses on nothing, axis 1");
  EXPECT_EQ(said_of([](DisplayLaw&, const DisplayLaw::Input& input, double scale) noexcept {
              return Axes{-scale * input.peer_torque_n_m[0], -scale * input.peer_torque_n_m[1]};
            }),
            "it would push by what is no number, axis 1");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              DisplayLaw::Input wrong = input;
              wrong.peer_active = true;
              return law.torque(wrong, scale);
            }),
            "it would show a robot that does not act, axis 1");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              for (std::size_t i = 0; i < torque.size(); ++i)
                if (dynamic_cast<PassivePositionForce*>(&law) != nullptr) torque[i] += 0.5 * input.velocity_rad_s[i];
              return torque;
            }),
            "passivity would drive the hand on, axis 1");
  EXPECT_EQ(said_of([](DisplayLaw&, const DisplayLaw::Input&, double) noexcept { return Axes{}; }),
            "it would not push against what the robot presses on, axis 1");
}

TEST(JoystickSelfCheck, FindsALawThatGoesByTheHand) {
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              torque[1] += 0.01 * input.velocity_rad_s[1];
              return torque;
            }),
            "it would push by how the hand moves, axis 2")
      << "damping of the wrong sign, whichever law";
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              Axes torque = law.torque(input, scale);
              torque[1] += 0.01 * input.velocity_rad_s[0];
              return torque;
            }),
            "it would push by the other axis, axis 2");
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              if (dynamic_cast<PassivePositionForce*>(&law) == nullptr) return law.torque(input, scale);
              PositionForce plain{0.0005};
              plain.take_over(law);
              static_cast<void>(law.torque(input, scale));
              return plain.torque(input, scale);
            }),
            "passivity would drive the hand on, axis 1")
      << "it takes nothing out";
}

TEST(JoystickSelfCheck, FindsALawThatGoesOnWhenTheRobotIsLost) {
  EXPECT_EQ(said_of([](DisplayLaw& law, const DisplayLaw::Input& input, double scale) noexcept {
              if (input.peer_active) return law.torque(input, scale);
              PositionForce again{0.0005};  // each time the first cycle of fading
              again.take_over(law);
              return again.torque(input, scale);
            }),
            "it would go on pushing when the robot is lost, axis 1");
}

}  // namespace
}  // namespace hirosco::joystick
