// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/joystick/joystick_device.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "simulation/devices/robot/world/two_joint_arm.hpp"

namespace hirosco::simulation {
namespace {

Mat2 robot_home_jacobian() noexcept {
  const ArmParameters robot;
  return placement_of(robot, robot.home_rad).jacobian;
}

constexpr double farthest_m = 0.2;
constexpr double unyielding = std::numeric_limits<double>::infinity();

}  // namespace

JoystickDevice::JoystickDevice(FlowFactory& flows, FlowAddress address, const Settings& settings,
                               const HandleParameters& handle, OpenStick open_stick)
    : SimulatedDevice{flows, std::move(address), settings},
      handle_{settings.seed, robot_home_jacobian(), handle},
      open_stick_{std::move(open_stick)} {}

Result<> JoystickDevice::take(OctetReader payload) noexcept {
  const Vec2 torque{payload.get<double>(), payload.get<double>()};
  const auto hand = payload.get<std::uint8_t>();
  const Vec2 intent{payload.get<double>(), payload.get<double>()};
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "joystick command size");
  if (hand <= static_cast<std::uint8_t>(stick_ ? Hand::Person : Hand::Commanded)) lay_on(static_cast<Hand>(hand));
  if (hand_ == Hand::Commanded && intent != intent_rad_ && std::isfinite(intent[0]) && std::isfinite(intent[1])) {
    const double range = handle_.parameters().range_rad;
    intent_rad_ = intent;
    handle_.hand().follow({std::clamp(intent[0], -range, range), std::clamp(intent[1], -range, range)});
  }
  for (std::size_t i = 0; i < 2; ++i) commanded_[i] = std::isfinite(torque[i]) ? torque[i] : 0;
  return ok();
}

void JoystickDevice::lay_on(Hand hand) noexcept {
  if (hand == hand_) return;
  hand_ = hand;
  OperatorHand& operators = handle_.hand();
  if (hand != Hand::Simulated) {
    wandered_ = wandered_ || operators.wandering();
    led_ = false;
    intent_rad_ = operators.intent().angle_rad;
    operators.hold(intent_rad_);
  } else if (wandered_) {
    operators.wander();
    wandered_ = false;
  }
}

void JoystickDevice::lead(const Vec2& target_rad) {
  OperatorHand& operators = handle_.hand();
  if (!led_) {
    led_hand_.begin(operators.intent());
    operators.custom([this](double) { return led_hand_.intent(); });
    led_ = true;
  }
  led_hand_.lead(target_rad);
}

void JoystickDevice::take_from_person() noexcept {
  const auto deflection = stick_->deflection();
  if (!deflection) {
    stick_.reset();
    static_cast<void>(fault("unplug"));
    return;
  }
  handle_.hand().follow(handle_.parameters().range_rad * *deflection);
  stick_->feel(1 / handle_.parameters().torque_max_n_m * applied_);
}

void JoystickDevice::advance(Duration cycle) noexcept {
  const double limit = handle_.parameters().torque_max_n_m;
  applied_ = output() == DeviceOutput::Active ? commanded_ : Vec2{};
  raise(device_flag::torque_saturated, std::abs(applied_[0]) > limit || std::abs(applied_[1]) > limit);
  for (double& torque : applied_) torque = std::clamp(torque, -limit, limit);
  if (hand_ == Hand::Person && stick_) take_from_person();
  // Who wanders gives way too: after a stop the robot may be coupled in another place than before.
  handle_.give_way_at(handle_.hand().wandering() ? led_hand_.limits().pull_n_m : unyielding);
  led_hand_.advance(handle_.angle_rad(), handle_.parameters().hand_stiffness_n_m_per_rad, seconds(cycle));
  handle_.step(applied_, cycle);
}

void JoystickDevice::write_sensors(OctetWriter& payload) noexcept {
  payload.put(handle_.angle_rad()[0]).put(handle_.angle_rad()[1]);
  payload.put(handle_.rate_rad_s()[0]).put(handle_.rate_rad_s()[1]);
  constexpr std::uint8_t simulated_and_commanded = 0b011, persons = 0b100;
  payload.put(static_cast<std::uint8_t>(hand_));
  payload.put(static_cast<std::uint8_t>(simulated_and_commanded | (stick_ ? persons : 0)));
}

Result<> JoystickDevice::hand(std::string_view line) { return fault("hand " + std::string{line}); }

Result<> JoystickDevice::do_fault(const Words& words) {
  if (words[0] == "stick") {
    HIROSCO_TRY(words.expect(2));
    if (!open_stick_) return fail(ErrorCode::Unavailable, "no sticks in this world");
    HIROSCO_TRY_LET(stick_, open_stick_(words[1]));
    return ok();
  }
  if (words[0] != "hand") return fail(ErrorCode::InvalidArgument, "unknown fault");
  if (hand_ != Hand::Simulated) return fail(ErrorCode::Unavailable, "another hand is on the handle");
  OperatorHand& hand = handle_.hand();
  const std::string_view what = words[1];
  if (what == "target") {
    HIROSCO_TRY(words.expect(4));
    const double range = handle_.parameters().range_rad;
    HIROSCO_TRY_LET(const double first, words.number(2, -1, 1));
    HIROSCO_TRY_LET(const double second, words.number(3, -1, 1));
    lead({std::clamp(first, -range, range), std::clamp(second, -range, range)});
    return ok();
  }
  led_ = false;  // for the next target to begin where the hand is then
  if (what == "wander") {
    HIROSCO_TRY(words.expect(2));
    hand.wander();
    return ok();
  }
  if (what == "hold") {
    HIROSCO_TRY(words.expect(4));
    HIROSCO_TRY_LET(const double first, words.number(2, -1, 1));
    HIROSCO_TRY_LET(const double second, words.number(3, -1, 1));
    hand.hold({first, second});
    return ok();
  }
  if (what == "sine") {
    HIROSCO_TRY(words.expect(words.count() == 6 ? 6 : 5));
    HIROSCO_TRY_LET(const double axis, words.number(2, 1, 2));
    HIROSCO_TRY_LET(const double amplitude, words.number(3, 0, 1));
    HIROSCO_TRY_LET(const double frequency, words.number(4, 0, 20));
    double phase = 0;
    if (words.count() == 6) {
      HIROSCO_TRY_LET(phase, words.number(5, -7, 7));
    }
    hand.sine(static_cast<std::size_t>(axis) - 1, amplitude, frequency, phase);
    return ok();
  }
  if (what == "ramp" || what == "cartesian") {
    HIROSCO_TRY(words.expect(5));
    HIROSCO_TRY_LET(const double dx, words.number(2, -farthest_m, farthest_m));
    HIROSCO_TRY_LET(const double dy, words.number(3, -farthest_m, farthest_m));
    HIROSCO_TRY_LET(const double pace, words.number(4, 1e-4, 1e4));
    what == "ramp" ? hand.ramp({dx, dy}, pace) : hand.cartesian({dx, dy}, pace);
    return ok();
  }
  return fail(ErrorCode::InvalidArgument, "hand: target, hold, sine, ramp, cartesian or wander");
}

std::string JoystickDevice::do_truth() const {
  const Vec2 hand = handle_.hand_torque_n_m();
  return fmt::format(
      "angle_1={:.6f} angle_2={:.6f} hand_torque_1={:.5f} hand_torque_2={:.5f} motor_1={:.5f} "
      "motor_2={:.5f} flags={}",
      handle_.angle_rad()[0], handle_.angle_rad()[1], hand[0], hand[1], applied_[0], applied_[1], flags());
}

}  // namespace hirosco::simulation
