// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/self_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace hirosco::joystick {
namespace {

constexpr double past_stop_rad = 0.15;  ///< the stops are of rubber: so far goes a hand that leans on one with 9 N m
/// No hand is faster.
constexpr double most_rad_s = 20;
constexpr double most_jump_rad = 0.01;  ///< beyond that, from one cycle to the next

/// Torques of a robot's joint: something touched, and more than the handle can show.
constexpr std::array presses_n_m{5.0, -5.0, 1000.0, -1000.0};
constexpr double smallest_n_m = 1e-9;

[[nodiscard]] std::unexpected<Error> fails(const char* what, std::size_t axis) noexcept {
  return fail(ErrorCode::Internal, what, static_cast<std::int64_t>(axis + 1));
}

/// What a hand is to feel where a robot's joint is pressed on by so much.
[[nodiscard]] double against(double pressed_n_m, double force_scale) noexcept {
  return std::clamp(-force_scale * pressed_n_m, -DisplayLaw::torque_max_n_m, DisplayLaw::torque_max_n_m);
}

/// Written so that what is no number fails.
[[nodiscard]] bool is_within(double value, double most) noexcept { return std::abs(value) <= most; }

}  // namespace

Result<Step> SelfCheck::step(const Seen& seen, bool first) noexcept {
  if (first) {
    done_ = quiet_ = 0;
    last_rad_ = seen.position_rad;
    HIROSCO_TRY(check_laws(seen));
  }
  HIROSCO_TRY(check_handle(seen));
  HIROSCO_TRY(check_rest(seen));
  return ++done_ < cycles ? again : done;
}

Result<> SelfCheck::check_handle(const Seen& seen) noexcept {
  if (!seen.alive) return fail(ErrorCode::Unavailable, "the handle says nothing");
  if (seen.hand >= 8 || (seen.hands >> seen.hand & 1) == 0)
    return fail(ErrorCode::Internal, "it tells of a hand that it has not, number", seen.hand);
  for (std::size_t i = 0; i < last_rad_.size(); ++i) {
    if (!is_within(seen.position_rad[i], range_rad + past_stop_rad))
      return fails("measured outside of its range, axis", i);
    if (!is_within(seen.velocity_rad_s[i], most_rad_s)) return fails("measured faster than a hand is, axis", i);
    if (!is_within(seen.position_rad[i] - last_rad_[i], most_rad_s * seen.period_s + most_jump_rad))
      return fails("measured to jump, axis", i);
  }
  last_rad_ = seen.position_rad;
  return ok();
}

/// What was shown fades for some cycles; behind those there is nothing that a hand could be pushed by.
Result<> SelfCheck::check_rest(const Seen& seen) noexcept {
  quiet_ = seen.peer_active ? 0 : quiet_ + 1;
  if (quiet_ <= DisplayLaw::ramp_cycles) return ok();
  for (std::size_t i = 0; i < seen.shown_n_m.size(); ++i)
    if (!is_within(seen.shown_n_m[i], smallest_n_m)) return fails("it would push though no robot presses, axis", i);
  return ok();
}

/// Both, as PASSIVITY may change them while the hand is on the stick; with the scale in force and the greatest.
Result<> SelfCheck::check_laws(const Seen& seen) const noexcept {
  for (const double scale : {seen.force_scale, most_scale}) {
    HIROSCO_TRY(check_law<PositionForce>(seen.period_s, scale));
    HIROSCO_TRY(check_law<PassivePositionForce>(seen.period_s, scale));
    HIROSCO_TRY(check_fading<PositionForce>(seen.period_s, scale));
    HIROSCO_TRY(check_fading<PassivePositionForce>(seen.period_s, scale));
    HIROSCO_TRY(check_damping(seen.period_s, scale));
  }
  return ok();
}

/// Of a handle at rest: the robot's torque scaled against the hand, in its axis alone, no more than the motors may give.
template <class Display>
Result<> SelfCheck::check_law(double period_s, double force_scale) const noexcept {
  const auto shown = [&](const DisplayLaw::Input& input) {
    Display fresh{period_s};
    return law_(fresh, input, force_scale);
  };
  constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t axis = 0; axis < last_rad_.size(); ++axis) {
    if (!is_within(shown({.peer_active = true})[axis], smallest_n_m))
      return fails("it would push though the robot presses on nothing, axis", axis);
    DisplayLaw::Input input{.peer_active = true};
    input.peer_torque_n_m[axis] = no_number;
    if (!is_within(shown(input)[axis], smallest_n_m)) return fails("it would push by what is no number, axis", axis);
    for (const double pressed : presses_n_m) {
      input.peer_torque_n_m[axis] = pressed;
      input.peer_active = false;
      if (!is_within(shown(input)[axis], smallest_n_m))
        return fails("it would show a robot that does not act, axis", axis);
      input.peer_active = true;
      const Axes answer = shown(input);
      if (!is_within(answer[axis] - against(pressed, force_scale), smallest_n_m))
        return fails("it would not push against what the robot presses on, axis", axis);
      const std::size_t other = 1 - axis;
      if (!is_within(answer[other], smallest_n_m)) return fails("it would push by the other axis, axis", other);
    }
  }
  return ok();
}

/// Who falls silent is felt ever less, and not at all behind the last cycle of that.
template <class Display>
Result<> SelfCheck::check_fading(double period_s, double force_scale) const noexcept {
  for (std::size_t axis = 0; axis < last_rad_.size(); ++axis) {
    Display silent{period_s};
    DisplayLaw::Input input{.peer_active = true};
    input.peer_torque_n_m[axis] = presses_n_m[0];
    double most_n_m = std::abs(law_(silent, input, force_scale)[axis]);
    input.peer_active = false;
    for (int cycle = 1; cycle <= DisplayLaw::ramp_cycles; ++cycle) {
      const double left_n_m = law_(silent, input, force_scale)[axis];
      if (!is_within(left_n_m, cycle < DisplayLaw::ramp_cycles ? most_n_m : smallest_n_m))
        return fails("it would go on pushing when the robot is lost, axis", axis);
      most_n_m = std::abs(left_n_m);
    }
  }
  return ok();
}

/// Of a hand that moves: the plain law shows the same as to one at rest; the passive one nothing of what would drive the hand on,
/// which is energy that it has not got, and all of what stands against it. Its damper may take twice what that is at most.
Result<> SelfCheck::check_damping(double period_s, double force_scale) const noexcept {
  constexpr double speed_rad_s = 1;
  constexpr const char* goes_by_hand = "it would push by how the hand moves, axis";
  for (std::size_t axis = 0; axis < last_rad_.size(); ++axis)
    for (const double velocity_rad_s : {speed_rad_s, -speed_rad_s})
      for (const double pressed : {presses_n_m[1], presses_n_m[0]}) {
        DisplayLaw::Input input{.peer_active = true};
        input.velocity_rad_s[axis] = velocity_rad_s;
        input.peer_torque_n_m[axis] = pressed;
        PositionForce plain{period_s};
        PassivePositionForce passive{period_s};
        const double wanted = against(pressed, force_scale);
        const Axes answer = law_(plain, input, force_scale);
        if (!is_within(answer[axis] - wanted, smallest_n_m)) return fails(goes_by_hand, axis);
        const std::size_t other = 1 - axis;
        if (!is_within(answer[other], smallest_n_m)) return fails("it would push by the other axis, axis", other);
        const bool drives = wanted * velocity_rad_s > 0;
        if (is_within(law_(passive, input, force_scale)[axis] - (drives ? 0 : wanted), smallest_n_m)) continue;
        return fails(drives ? "passivity would drive the hand on, axis" : goes_by_hand, axis);
      }
  return ok();
}

}  // namespace hirosco::joystick
