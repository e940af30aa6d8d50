// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/robot_arm.hpp"

#include <algorithm>

namespace hirosco {

using robot_arm::Excess;
using robot_arm::Joints;
using robot_arm::JointVector;
using robot_arm::Setpoints;
using robot_arm::Vector3;
using robot_arm::Vector6;

namespace {

/// So long a goal has to be measured before it counts as reached, and at most so long after the end of the path.
constexpr double settled_enough_s = 0.02;
constexpr double patience_s = 3;
/// A telecommand is waited for a little longer.
constexpr double longest_motion_s = 60;
/// Of a line, before it is given up; of its end, where the tool has to be measured.
constexpr double most_off_line_m = 0.002, most_off_end_m = 0.001;

[[nodiscard]] std::int64_t millimetres(double metres) noexcept {
  return static_cast<std::int64_t>(std::clamp(1e3 * metres, -1e6, 1e6));
}

}  // namespace

std::unique_ptr<Subsystem> make_robot_arm() { return std::make_unique<RobotArm>(); }

Result<> RobotArm::pre_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  return ok();
}

/// The law runs on the present position: what would be put out is visible, nothing moves.
Result<> RobotArm::safe_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    drop_calls(watch_.tripped().has_value());
    clearance_->set_limit(clearance_limit_m_.load());  // it may have been written since CONFIGURE
  }
  engage();
  control();
  watch(false);
  return ok();
}

Result<> RobotArm::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    watch_.arm();
    stopped_ = false;
  }
  if (cycle.first || !cycle.active) {
    if (!cycle.active) drop_calls(watch_.tripped().has_value());  // inhibited it could never end
    engage();
  } else {
    advance();
  }
  control();
  watch(cycle.active);
  if (cycle.active && !cycle.first) watch_contact();
  if (stopped_) inhibit_actuators();
  moving_ = cycle.active && !watch_.tripped() && !stopped_;
  active_.store(moving_ ? 1 : 0);
  return ok();
}

Result<> RobotArm::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) drop_calls(watch_.tripped().has_value());
  device_.output().torque = Joints::zeros(bounds_.size());
  return ok();
}

void RobotArm::measure(const Cycle& cycle) noexcept {
  const robot_arm::ArmInput& in = device_.input();
  current_.store({static_cast<std::int32_t>(cycle.state), in.position, in.velocity, in.torque, device_.flags()});
  active_.store(0);
  moving_ = false;
  measured_ = {robot_arm::vector_of(in.position), robot_arm::vector_of(in.velocity), robot_arm::vector_of(in.torque)};
  model_state_.q = measured_.position;
  model_state_.qd = measured_.velocity;
  const auto gravity = gravity_m_s2_.load();
  dynamics_->set_gravity({gravity[0], gravity[1], gravity[2]});
  dynamics_->update(model_state_);
  const robotics::Pose tip = dynamics_->frame_pose(tip_);
  const auto place = tool_place_m_.load();
  const Vector3 tool = tip * Vector3{place[0], place[1], place[2]};
  const robotics::Quaternion turned{tip.rotation};
  tool_values_.store({{tool.x(), tool.y(), tool.z()}, {turned.w(), turned.x(), turned.y(), turned.z()}});
  robotics::Coordinates of_payload = robotics::Coordinates::Zero(model_->joint_count());
  robot_arm::Law::add_payload(payload(), tip_, {gravity[0], gravity[1], gravity[2]}, *dynamics_,
                              JointVector::Zero(model_->joint_count()), of_payload);
  observer_->update(measured_, *dynamics_, of_payload);
  external_torque_.store(robot_arm::joints_of(observer_->external()));
}

// --- the setpoint ------------------------------------------------------------------------------------------------------

/// Takes the present position as the reference: entering Operational moves nothing.
void RobotArm::engage() noexcept {
  setpoints_->begin(measured_.position);
  clearance_m_.store(clearance_->nearest(measured_.position).distance_m);
  laws_->reset();
  contact_cycles_ = 0;
  retracting_ = false;
}

void RobotArm::advance() noexcept {
  if (jog_left_s_ > 0 && (jog_left_s_ -= cycle_s_) <= 0) setpoints_->brake();
  if (floats()) setpoints_->begin(measured_.position);
  static_cast<void>(setpoints_->advance());
  watch_clearance();
  watch_yielding();
  end_retract();
  const double progressed = setpoints_->progress();
  motion_values_.store({static_cast<std::uint8_t>(setpoints_->kind()), setpoints_->duration_s(), progressed});
  if (setpoints_->at_rest()) at_rest_for_stop();
  if (!motion_) return;
  if (setpoints_->off_line_m() > most_off_line_m) return lose_line();
  if (arrives_ && !half_reported_ && progressed >= 0.5) {
    half_reported_ = true;
    progress(*motion_, 1);
  }
  if (setpoints_->at_rest()) arrive();
}

/// What is in the way can be seen from here alone: where it would be, a line needs another posture.
void RobotArm::lose_line() noexcept {
  if (const auto joint = setpoints_->joint_in_the_way())
    end_motion(Trouble::line_lost, "on the line ends the range of joint", static_cast<std::int64_t>(*joint + 1));
  else end_motion(Trouble::line_lost, "on the line is a singular posture, after mm", millimetres(setpoints_->gone_m()));
  setpoints_->brake();
}

/// The end of a path is not yet the goal: a motion is done when it is measured there, and rests. Who gives way is wherever he was
/// pushed, and done with his path.
void RobotArm::arrive() noexcept {
  const double tolerance = goal_tolerance_.load();
  const JointVector left = setpoints_->now().position - measured_.position;
  // A long arm's joints are all there, and its tool is not.
  const auto tool = tool_values_.load().position_m;
  const bool at_end = !line_to_ || (Vector3{tool[0], tool[1], tool[2]} - *line_to_).norm() <= most_off_end_m;
  const bool there = laws_->gives_way() || (at_end && left.cwiseAbs().maxCoeff() <= tolerance);
  settled_s_ = there ? settled_s_ + cycle_s_ : 0;
  waited_s_ += cycle_s_;
  if (settled_s_ >= settled_enough_s) {
    raise(motion_done_);
    finish(*motion_);
    motion_.reset();
  } else if (waited_s_ > patience_s) {
    end_motion(Trouble::goal_not_reached);
  }
}

// --- the law and its guards --------------------------------------------------------------------------------------------

robot_arm::Payload RobotArm::payload() const noexcept {
  const auto values = payload_values_.load();
  return {values.mass_kg, {values.place_m[0], values.place_m[1], values.place_m[2]}};
}

robot_arm::Laws::Settings RobotArm::law_settings() noexcept {
  const auto gravity = gravity_m_s2_.load();
  rotor_ = rotor_inertia_.load();
  return {.position = {.bandwidth_rad_s = bandwidth_rad_s_.load(),
                       .rotor = rotor_,
                       .gravity_m_s2 = {gravity[0], gravity[1], gravity[2]}},
          .float_damping_per_s = float_damping_.load()};
}

void RobotArm::control() noexcept {
  const robot_arm::Setpoint& wanted = setpoints_->now();
  desired_position_.store(robot_arm::joints_of(wanted.position));
  desired_velocity_.store(robot_arm::joints_of(wanted.velocity));
  device_.output().torque =
      robot_arm::joints_of(laws_->torque(wanted, measured_, *dynamics_, payload(), bounds_, law_settings()));
  const robot_arm::Impedance& impedance = laws_->impedance();
  law_values_.store(
      {static_cast<std::uint8_t>(laws_->kind()), impedance.tool_n_m, impedance.tool_n_m_rad, impedance.damping_ratio});
  joint_stiffness_.store(robot_arm::joints_of(impedance.joint_n_m_rad));
}

/// Each limit is told once until the next entry into Operational; it stays in force when the actuators are inhibited.
void RobotArm::watch(bool follows) noexcept {
  const robot_arm::Watch::Limits limits{.speed_share = speed_limit_.load(),
                                        .torque_share = torque_limit_.load(),
                                        .torque_hard_share = torque_hard_.load(),
                                        .following = following_limit_.load()};
  const auto* setpoint = follows && !laws_->gives_way() ? &setpoints_->now().position : nullptr;
  const auto found = watch_.update(measured_, setpoint, bounds_, limits);
  if (watch_.tripped()) inhibit_actuators();
  if (!found) return;
  const auto& event = found->what == Excess::Position     ? position_exceeded_
                      : found->what == Excess::Speed      ? speed_exceeded_
                      : found->what == Excess::Torque     ? torque_exceeded_
                      : found->what == Excess::TorqueHard ? torque_hard_exceeded_
                                                          : following_exceeded_;
  raise(event, static_cast<std::uint8_t>(found->joint + 1), found->value, found->limit);
}

/// Where it would come to rest if it braked now. Who creeps is looked at a little farther on, so that what he comes nearer is more than a search
/// for a distance is off.
JointVector RobotArm::ahead_of_setpoint() const noexcept {
  constexpr double least_way = 1e-4;
  const JointVector& now = setpoints_->now().position;
  const JointVector way = setpoints_->braked() - now;
  const double most = way.cwiseAbs().maxCoeff();
  return most > 0 && most < least_way ? JointVector{now + least_way / most * way} : JointVector{now + way};
}

/// Comes to rest before links meet, or one of them what it is to keep out of; who is too near already may go away.
void RobotArm::watch_clearance() noexcept {
  const double now_m = clearance_->nearest(setpoints_->now().position).distance_m;
  clearance_m_.store(now_m);
  if (setpoints_->at_rest() || setpoints_->braking()) return;
  const auto ahead = clearance_->nearer(setpoints_->now().position, ahead_of_setpoint());
  if (ahead.distance_m == HUGE_VAL) return;
  raise(too_near_, ahead.distance_m);
  if (motion_) abort(*motion_, Trouble::too_near, ahead.names, millimetres(ahead.distance_m));
  motion_.reset();
  jog_left_s_ = 0;
  setpoints_->brake();
}

// --- functions ---------------------------------------------------------------------------------------------------------

bool RobotArm::in_range(const JointVector& goal) const noexcept {
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const double value = goal[static_cast<Eigen::Index>(i)];
    if (!(value >= bounds_[i].lowest && value <= bounds_[i].highest)) return false;
  }
  return true;
}

Outcome RobotArm::may_move() const noexcept {
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (floats()) return refused(Trouble::led, "HOLD first");
  if (motion_ || stop_ || !setpoints_->at_rest()) return refused(pus::FailureCode::Busy);
  return running;
}

Outcome RobotArm::start(const Result<>& planned, const Call& call) noexcept {
  if (!planned) return refused(Trouble::no_goal, planned.error().text, planned.error().value);
  if (setpoints_->duration_s() > longest_motion_s) {
    setpoints_->rest(setpoints_->now().position);
    return refused(Trouble::too_slow, "it would take longer, s", static_cast<std::int64_t>(longest_motion_s));
  }
  motion_ = call;
  line_to_.reset();
  half_reported_ = false;
  arrives_ = true;
  settled_s_ = waited_s_ = jog_left_s_ = 0;
  return running;
}

Outcome RobotArm::move_j(const FunctionValues& values, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  const JointVector goal = robot_arm::vector_of(std::span{values}.first(bounds_.size()));
  if (!in_range(goal)) return refused(Trouble::out_of_range);
  if (const auto there = clearance_->nearer(setpoints_->now().position, goal); there.distance_m < HUGE_VAL)
    return refused(Trouble::too_near, there.names, millimetres(there.distance_m));
  return start(setpoints_->go(goal, values[bounds_.size()]), call);
}

Outcome RobotArm::move_l(const FunctionValues& values, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  const robotics::Quaternion wanted{values[3], values[4], values[5], values[6]};
  if (!(wanted.norm() > 0.5 && wanted.norm() < 1.5)) return refused(Trouble::no_goal, "no orientation");
  const robotics::Pose goal{wanted.normalized().toRotationMatrix(), {values[0], values[1], values[2]}};
  const Outcome started = start(setpoints_->go_straight(goal, {values[7], values[8]}), call);
  if (started.kind != Outcome::Kind::Refused) line_to_ = goal.position;
  return started;
}

Outcome RobotArm::jog_j(const FunctionValues& values, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  setpoints_->jog(robot_arm::vector_of(std::span{values}.first(bounds_.size())));
  motion_ = call;
  line_to_.reset();
  arrives_ = false;
  settled_s_ = waited_s_ = 0;
  jog_left_s_ = values[bounds_.size()];
  return running;
}

Outcome RobotArm::jog_l(const FunctionValues& values, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  Vector6 twist;
  twist << values[3], values[4], values[5], values[0], values[1], values[2];
  setpoints_->jog(twist);
  motion_ = call;
  line_to_.reset();
  arrives_ = false;
  settled_s_ = waited_s_ = 0;
  jog_left_s_ = values[6];
  return running;
}

/// A limit that the arm's present load exceeds already would only stop it.
Outcome RobotArm::set_torque_limit(double share) noexcept {
  if (measured_.torque.size() == 0) return refused(pus::FailureCode::NotPermittedNow);
  for (std::size_t i = 0; i < bounds_.size(); ++i)
    if (!(std::abs(measured_.torque[static_cast<Eigen::Index>(i)]) < share * bounds_[i].effort))
      return refused(Trouble::load_above_limit, "joint", static_cast<std::int64_t>(i + 1));
  torque_limit_.store(share);
  return ok();
}

Outcome RobotArm::keep_out(const robot_arm::KeepOut& numbers) noexcept {
  if (!clearance_) return refused(pus::FailureCode::NotPermittedNow);
  std::array<robotics::Capsule, robotics::Clearance::most_volumes> volumes;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const double* its = numbers.data() + i * robot_arm::volume_numbers;
    volumes[i] = {{its[0], its[1], its[2]}, {its[3], its[4], its[5]}, its[6]};
  }
  clearance_->keep_out(volumes);
  keep_out_.store(numbers);
  return ok();
}

void RobotArm::bind_functions() {
  on_function("MOVE_J", [this](const FunctionValues& values, Call call) { return move_j(values, call); });
  on_function("MOVE_L", [this](const FunctionValues& values, Call call) { return move_l(values, call); });
  on_function("JOG_J", [this](const FunctionValues& values, Call call) { return jog_j(values, call); });
  on_function("JOG_L", [this](const FunctionValues& values, Call call) { return jog_l(values, call); });
  bind_hold_and_stop();
  on_function("SET_TORQUE_LIMIT", [this](double share) { return set_torque_limit(share); });
  on_function("KEEP_OUT", [this](const robot_arm::KeepOut& numbers) { return keep_out(numbers); });
  on_function("SET_CONTACT", [this](std::uint8_t reaction, double limit) -> Outcome {
    contact_values_.store({reaction, limit});
    return ok();
  });
  on_function("SET_PAYLOAD", [this](double mass_kg, std::array<double, 3> place_m) -> Outcome {
    payload_values_.store({mass_kg, place_m});
    if (observer_) observer_->reset();
    if (laws_) laws_->forget_learnt();  // else it would be held twice
    return ok();
  });
  on_function("SET_TOOL", [this](std::array<double, 3> place_m) -> Outcome {
    if (!setpoints_) return refused(pus::FailureCode::NotPermittedNow);
    if (motion_ || stop_ || !setpoints_->at_rest()) return refused(pus::FailureCode::Busy);
    tool_place_m_.store(place_m);
    setpoints_->set_tool({robotics::Matrix3::Identity(), {place_m[0], place_m[1], place_m[2]}});
    laws_->set_tool({place_m[0], place_m[1], place_m[2]});
    return ok();
  });
  bind_laws();
}

}  // namespace hirosco
