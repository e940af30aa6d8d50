// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/robot_gripper.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco {

using robot_gripper::Excess;
using robot_gripper::Held;
using robot_gripper::Joints;
using robot_gripper::Law;

namespace {

/// So long a goal has to be measured before it counts as reached, and at most so long after the end of the path.
constexpr double settled_enough_s = 0.02;
constexpr double patience_s = 3;
/// So long the wanted force, at rest, before something counts as held.
constexpr double held_after_s = 0.1;
/// Farther behind than it may be for so long: something is in the way.
constexpr double obstructed_after_s = 0.05;
/// A telecommand is waited for a little longer.
constexpr double longest_motion_s = 60;
constexpr double rest_m_s = 0.002, back_off_m_s = 0.01;
/// Of all efforts: what may be asked for. Trimming goes a little beyond.
constexpr double most_force_share = 0.8;

[[nodiscard]] std::int64_t micrometres(double metres) noexcept {
  return static_cast<std::int64_t>(std::clamp(1e6 * metres, -1e9, 1e9));
}

}  // namespace

std::unique_ptr<Subsystem> make_robot_gripper() { return std::make_unique<RobotGripper>(); }

Result<> RobotGripper::pre_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  tell_gap();
  return ok();
}

/// The law runs on the present width: what would be put out is visible, the brakes hold. What is held stays held, and is watched.
Result<> RobotGripper::safe_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    drop_calls(watch_.tripped());
    HIROSCO_TRY(take_values());
    recognise();
  }
  watch_held();
  engage();
  control();
  watch();
  return ok();
}

Result<> RobotGripper::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    watch_.arm();
    stopped_ = false;
    recognise();
  }
  watch_held();
  if (cycle.first || !cycle.active) {
    if (!cycle.active) drop_calls(watch_.tripped());  // inhibited it could never end
    engage();
  } else {
    advance();
  }
  control();
  watch();
  if (stopped_) inhibit_actuators();
  moving_ = cycle.active && !watch_.tripped() && !stopped_;
  active_.store(moving_ ? 1 : 0);
  return ok();
}

Result<> RobotGripper::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) drop_calls(watch_.tripped());
  tell_gap();
  device_.output().torque = Joints::zeros(fingers_.count());
  return ok();
}

void RobotGripper::measure(const Cycle& cycle) noexcept {
  const robot_gripper::GripperInput& in = device_.input();
  current_.store({static_cast<std::int32_t>(cycle.state), in.position, in.velocity, in.torque, device_.flags()});
  active_.store(0);
  moving_ = false;
  measured_ = {in.position, in.velocity, in.torque};
  width_m_ = fingers_.width(measured_.position);
  speed_m_s_ = fingers_.speed(measured_.velocity);
  force_n_ = fingers_.force(measured_.torque);
}

// --- what is wanted ------------------------------------------------------------------------------------------------------

/// Entering Operational moves nothing: it keeps the width, or goes on pressing on what it holds as hard as it did.
void RobotGripper::engage() noexcept {
  opening_.rest(width_m_);
  if (held_.held()) grip_.press_on(held_force_n_, grip_speed_m_s_);
  else grip_.keep();
}

/// Who was configured anew, or died, has forgotten what he held: brakes that press on something tell him.
void RobotGripper::recognise() noexcept {
  if (held_.held() || !(force_n_ >= felt_force_n_.load()) || !(width_m_ > empty_width_m_.load())) return;
  held_.hold(width_m_);
  held_force_n_ = std::min(force_n_, most_force_n());
  raise(held_told_, width_m_, force_n_);
}

/// Comes to rest where it is. Who presses goes on: nothing is let go of that was not told to be.
void RobotGripper::stand() noexcept {
  if (grip_.law() == Law::Press) return;
  if (grip_.law() == Law::Width) {
    opening_.brake();
    return;
  }
  opening_.brake_from(width_m_, speed_m_s_);
  grip_.keep();
}

void RobotGripper::advance() noexcept {
  opening_.advance();
  if (grip_.law() == Law::Width) follow_path();
  else follow_grip();
  if (opening_.at_rest() && !(std::abs(speed_m_s_) > rest_m_s)) at_rest_for_stop();
}

/// A motion is done when it is measured at its goal, and rests.
void RobotGripper::follow_path() noexcept {
  if (!motion_) return;
  // Who springs open from what it pressed on is ahead: nothing is in his way.
  const double off_m = opening_.now().width_m - width_m_, left_m = goal_m_ - opening_.now().width_m;
  const double behind_m = off_m * left_m < 0 ? 0 : std::abs(off_m);
  behind_s_ = behind_m > following_limit_m_.load() ? behind_s_ + cycle_s_ : 0;
  if (behind_s_ >= obstructed_after_s) {
    end_motion(Trouble::obstructed);
    back_off();
    return;
  }
  if (!reported_ && opening_.progress() >= 0.5) {
    reported_ = true;
    progress(*motion_, 1);
  }
  if (!opening_.at_rest()) return;
  settled_s_ = std::abs(goal_m_ - width_m_) <= width_tolerance_m_.load() ? settled_s_ + cycle_s_ : 0;
  waited_s_ += cycle_s_;
  if (settled_s_ >= settled_enough_s) {
    raise(motion_done_);
    finish(*motion_);
    motion_.reset();
  } else if (waited_s_ > patience_s) {
    end_motion(Trouble::width_not_reached);
    opening_.rest(width_m_);
  }
}

/// Keeping the width where something is in the way would go on pressing on it.
void RobotGripper::back_off() noexcept {
  const double back_m = goal_m_ < width_m_ ? following_limit_m_.load() : -following_limit_m_.load();
  opening_.rest(width_m_);
  grip_.keep();
  // Planned between two numbers within the range: it has a way.
  static_cast<void>(opening_.go(std::clamp(width_m_ + back_m, 0.0, fingers_.full_width_m()), back_off_m_s));
}

void RobotGripper::follow_grip() noexcept {
  const bool presses = grip_.law() == Law::Press;
  if (motion_ && presses && !reported_) {
    reported_ = true;
    progress(*motion_, 1);
  }
  if (presses && grip_.settled_s() >= held_after_s && (motion_ || !held_.held())) {
    if (width_m_ <= empty_width_m_.load()) {
      raise(nothing_met_, width_m_);
      end_motion(Trouble::nothing_met);
      opening_.rest(width_m_);
      grip_.keep();
      return;
    }
    held_.hold(width_m_);
    held_force_n_ = grip_.wanted_force_n();
    raise(held_told_, width_m_, force_n_);
    if (motion_) finish(*motion_);
    motion_.reset();
  }
  if (!motion_ && !presses && !held_.held()) stand();  // nobody is waiting for it to meet something
  if (!motion_) return;
  waited_s_ = presses ? waited_s_ + cycle_s_ : 0;
  // It goes on pressing: there may be something.
  if (waited_s_ > patience_s) end_motion(Trouble::force_not_reached);
}

// --- the law and its guards ------------------------------------------------------------------------------------------------

void RobotGripper::control() noexcept {
  device_.output().torque = grip_.torques(opening_.now(), measured_);
  tell_gap();
}

void RobotGripper::tell_gap() noexcept {
  gap_values_.store({width_m_, speed_m_s_, force_n_, static_cast<std::uint8_t>(held_.held() ? 1 : 0),
                     static_cast<std::uint8_t>(grip_.law()),
                     grip_.law() == Law::Width ? opening_.now().width_m : held_.width_m(), grip_.wanted_force_n(),
                     held_.width_m()});
}

/// Each limit is told once until the next entry into Operational; it stays in force when the actuators are inhibited.
void RobotGripper::watch() noexcept {
  const auto found =
      watch_.update(measured_, fingers_, {.speed_share = speed_limit_.load(), .force_share = force_hard_.load()});
  if (watch_.tripped()) inhibit_actuators();
  if (!found) return;
  const auto& event = found->what == Excess::Position ? position_exceeded_
                      : found->what == Excess::Speed  ? speed_exceeded_
                                                      : force_exceeded_;
  raise(event, static_cast<std::uint8_t>(found->joint + 1), found->value, found->limit);
}

/// Who closes on nothing stands; who was forced open goes on pressing, as what forced it may still be there.
void RobotGripper::watch_held() noexcept {
  const Held::Change change = held_.update(width_m_, lost_distance_m_.load());
  if (change == Held::Change::None) return;
  raise(lost_told_, width_m_, held_.width_m());
  end_motion(Trouble::object_lost);
  if (change == Held::Change::LostOpened) return;
  opening_.brake_from(width_m_, speed_m_s_);
  grip_.keep();
}

// --- functions -----------------------------------------------------------------------------------------------------------

double RobotGripper::most_force_n() const noexcept { return most_force_share * fingers_.most_force_n(); }

Outcome RobotGripper::may_move() const noexcept {
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (motion_ || stop_ || !opening_.at_rest()) return refused(pus::FailureCode::Busy);
  return running;
}

Outcome RobotGripper::move_to(double width_m, double speed_m_s, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  if (!(width_m >= 0 && width_m <= fingers_.full_width_m()))
    return refused(Trouble::out_of_range, "micrometres at most", micrometres(fingers_.full_width_m()));
  if (!(speed_m_s <= fingers_.most_speed_m_s()))
    return refused(Trouble::out_of_range, "micrometres a second at most", micrometres(fingers_.most_speed_m_s()));
  if (held_.held() && width_m <= width_m_) return refused(Trouble::is_held, "GRIP with another force, or open");
  if (std::abs(width_m - width_m_) > longest_motion_s * speed_m_s)
    return refused(Trouble::too_slow, "it would take longer, s", static_cast<std::int64_t>(longest_motion_s));
  if (grip_.law() != Law::Width) {
    opening_.rest(width_m_);
    grip_.let_go();
  }
  if (const auto planned = opening_.go(width_m, speed_m_s); !planned)
    return refused(Trouble::no_goal, planned.error().text, planned.error().value);
  if (held_.held()) raise(released_, width_m_);
  held_.let_go();
  motion_ = call;
  goal_m_ = width_m;
  reported_ = false;
  waited_s_ = settled_s_ = behind_s_ = 0;
  return running;
}

Outcome RobotGripper::grip(double force_n, double speed_m_s, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  if (!(force_n <= most_force_n()))
    return refused(Trouble::out_of_range, "millinewtons at most", static_cast<std::int64_t>(1e3 * most_force_n()));
  if (!(speed_m_s <= fingers_.most_speed_m_s()))
    return refused(Trouble::out_of_range, "micrometres a second at most", micrometres(fingers_.most_speed_m_s()));
  if (!held_.held() && width_m_ > longest_motion_s * speed_m_s)
    return refused(Trouble::too_slow, "it would take longer, s", static_cast<std::int64_t>(longest_motion_s));
  opening_.rest(width_m_);
  grip_.grip(force_n, speed_m_s);
  grip_speed_m_s_ = speed_m_s;
  held_force_n_ = force_n;
  motion_ = call;
  reported_ = false;
  waited_s_ = 0;
  return running;
}

void RobotGripper::bind_functions() {
  on_function("MOVE_TO",
              [this](double width_m, double speed_m_s, Call call) { return move_to(width_m, speed_m_s, call); });
  on_function("OPEN",
              [this](double speed_m_s, Call call) { return move_to(fingers_.full_width_m(), speed_m_s, call); });
  on_function("GRIP", [this](double force_n, double speed_m_s, Call call) { return grip(force_n, speed_m_s, call); });
  bind_hold_and_stop();
}

}  // namespace hirosco
