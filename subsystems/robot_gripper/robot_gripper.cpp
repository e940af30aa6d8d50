// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/robot_gripper.hpp"

#include <cmath>
#include <initializer_list>
#include <string_view>

#include "robotics/motion/sampled_rates.hpp"
namespace hirosco {

using robot_gripper::Excess;
using robot_gripper::Gap;
using robot_gripper::Held;
using robot_gripper::MotionProgress;
using robot_gripper::Trouble;
using robot_gripper::UrdfFingers;

namespace {

constexpr double rest_m_s = 0.002;

}  // namespace

std::unique_ptr<Subsystem> make_robot_gripper() { return std::make_unique<RobotGripper>(); }

Result<Step> RobotGripper::software_init() {
  parameters_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  use_device(UrdfFingers::device, drives_.port(),
             {robotics::urdf::model_setting, UrdfFingers::fingers_setting, UrdfFingers::closed_setting});
  for (EventPort* event :
       std::initializer_list<EventPort*>{&motion_done_, &held_told_, &lost_told_, &released_, &nothing_met_,
                                         &position_exceeded_, &speed_exceeded_, &force_exceeded_})
    use_event(*event);
  HIROSCO_TRY(known_.read(own_descriptor()));
  bind_functions();
  return done;
}

void RobotGripper::bind_functions() {
  on_function("MOVE_TO",
              [this](double width_m, double speed_m_s, Call call) { return move_to(width_m, speed_m_s, call); });
  on_function("OPEN", [this](double speed_m_s, Call call) {
    return move_to(known_.fingers().full_width_m(), speed_m_s, call);
  });
  on_function("GRIP", [this](double force_n, double speed_m_s, Call call) { return grip(force_n, speed_m_s, call); });
  bind_hold_and_stop();
}

Result<> RobotGripper::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY(drives_.check_lengths(known_.joints()));
  cycle_s_ = seconds(configuration.sampling);
  HIROSCO_TRY(robotics::check_cycle(cycle_s_));
  HIROSCO_TRY(known_.reckon(parameters_.rotor_inertia.load(), parameters_.full_width_m.load()));
  HIROSCO_TRY(take_values());
  handling_.forget();
  watch_.arm();
  forget_motion();
  return ok();
}

/// Those that may be written in Pre-Operational after CONFIGURE as well as before.
Result<> RobotGripper::take_values() noexcept {
  HIROSCO_TRY(known_.take_rotors(parameters_.rotor_inertia.load()));
  handling_.take_values(cycle_s_);
  return ok();
}

Result<> RobotGripper::pre_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  handling_.tell();
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
  handling_.engage();
  handling_.control();
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
    handling_.engage();
  } else {
    advance();
  }
  handling_.control();
  watch();
  if (stopped_) inhibit_actuators();
  moving_ = cycle.active && !watch_.tripped() && !stopped_;
  parameters_.active.store(moving_ ? 1 : 0);
  return ok();
}

Result<> RobotGripper::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) drop_calls(watch_.tripped());
  handling_.tell();
  drives_.put_nothing_out();
  return ok();
}

void RobotGripper::measure(const Cycle& cycle) noexcept {
  drives_.measure(cycle.state);
  parameters_.active.store(0);
  moving_ = false;
}

// --- what comes of it, told ----------------------------------------------------------------------------------------------

void RobotGripper::recognise() noexcept {
  if (handling_.recognise()) raise(held_told_, drives_.gap().width_m, drives_.gap().force_n);
}

void RobotGripper::advance() noexcept {
  tell(handling_.advance(motion_.has_value()));
  if (handling_.at_rest() && !(std::abs(drives_.gap().speed_m_s) > rest_m_s)) at_rest_for_stop();
}

/// What is held or not there is told whoever asked for it; steps and other ends there are of a motion alone.
void RobotGripper::tell(const MotionProgress::News& news) noexcept {
  const Gap& gap = drives_.gap();
  if (news.step) progress(*motion_, 1);
  switch (news.end) {
    case MotionProgress::End::None: return;
    case MotionProgress::End::Reached:
      raise(motion_done_);
      complete_motion();
      return;
    case MotionProgress::End::NotReached: end_motion(Trouble::width_not_reached); return;
    case MotionProgress::End::Obstructed: end_motion(Trouble::obstructed); return;
    case MotionProgress::End::Held:
      raise(held_told_, gap.width_m, gap.force_n);
      complete_motion();
      return;
    case MotionProgress::End::NothingMet:
      raise(nothing_met_, gap.width_m);
      end_motion(Trouble::nothing_met);
      return;
    case MotionProgress::End::ForceNotReached: end_motion(Trouble::force_not_reached); return;
  }
}

void RobotGripper::complete_motion() noexcept {
  if (motion_) finish(*motion_);
  motion_.reset();
}

void RobotGripper::watch_held() noexcept {
  if (handling_.watch_held() == Held::Change::None) return;
  raise(lost_told_, drives_.gap().width_m, handling_.held_width_m());
  end_motion(Trouble::object_lost);
}

/// Each limit is told once until the next entry into Operational; it stays in force when the actuators are inhibited.
void RobotGripper::watch() noexcept {
  const auto found =
      watch_.update(drives_.measured(), known_.fingers(),
                    {.speed_share = parameters_.speed_limit.load(), .force_share = parameters_.force_hard.load()});
  if (watch_.tripped()) inhibit_actuators();
  if (!found) return;
  const auto& event = found->what == Excess::Position ? position_exceeded_
                      : found->what == Excess::Speed  ? speed_exceeded_
                                                      : force_exceeded_;
  raise(event, static_cast<std::uint8_t>(found->joint + 1), found->value, found->limit);
}

// --- functions -----------------------------------------------------------------------------------------------------------

Outcome RobotGripper::may_move() const noexcept {
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (motion_ || stop_ || !handling_.at_rest()) return refused(pus::FailureCode::Busy);
  return running;
}

Outcome RobotGripper::move_to(double width_m, double speed_m_s, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  const bool held = handling_.holds();
  if (const Outcome begun = handling_.move_to(width_m, speed_m_s); begun.kind == Outcome::Kind::Refused) return begun;
  if (held) raise(released_, drives_.gap().width_m);
  motion_ = call;
  return running;
}

Outcome RobotGripper::grip(double force_n, double speed_m_s, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  if (const Outcome begun = handling_.grip(force_n, speed_m_s); begun.kind == Outcome::Kind::Refused) return begun;
  motion_ = call;
  return running;
}

}  // namespace hirosco
