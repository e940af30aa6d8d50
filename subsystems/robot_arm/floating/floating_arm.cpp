// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_arm.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hirosco {

using robot_arm::Joints;
using robot_arm::JointVector;
using robot_arm::ToolLaw;
using robotics::Matrix3;
using robotics::Quaternion;
using robotics::Vector3;

namespace {

constexpr double joint_error_per_s = 5;
/// So long a goal has to be measured before it counts as reached, and at most so long after the end of the path.
constexpr double settled_enough_s = 0.1, patience_s = 10;
constexpr double joint_tolerance_rad = 1e-3;
/// Of the filter before the tool's error, which single samples of a star tracker would hide.
constexpr double error_filter_s = 0.5;

[[nodiscard]] std::array<double, 3> three_of(const Vector3& v) noexcept { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] std::array<double, 4> four_of(const Quaternion& q) noexcept { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace

std::unique_ptr<Subsystem> make_floating_arm() { return std::make_unique<FloatingArm>(); }

Result<> FloatingArm::pre_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  return ok();
}

/// The law runs on the present place: what would be put out is visible, nothing moves.
Result<> FloatingArm::safe_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) end_motion(pus::FailureCode::Aborted);
  engage();
  control();
  watch();
  return ok();
}

Result<> FloatingArm::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    watch_.arm();
    braked_ = false;
  }
  if (cycle.first || !cycle.active) {
    if (!cycle.active) end_motion(pus::FailureCode::Aborted);  // inhibited it could never end
    engage();
  } else {
    advance();
  }
  control();
  watch();
  if (cycle.active && !braked_ && !may_act()) braked_ = true;
  if (braked_) inhibit_actuators();
  moving_ = cycle.active && !watch_.tripped() && !braked_;
  active_.store(moving_ ? 1 : 0);
  return ok();
}

Result<> FloatingArm::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) end_motion(pus::FailureCode::Aborted);
  device_.output().torque = Joints::zeros(bounds_.size());
  return ok();
}

void FloatingArm::measure(const Cycle& cycle) noexcept {
  const ArmInput& in = device_.input();
  current_.store({static_cast<std::int32_t>(cycle.state), in.position, in.velocity, in.torque, device_.flags()});
  active_.store(0);
  moving_ = false;
  measured_ = {robot_arm::vector_of(in.position), robot_arm::vector_of(in.velocity), robot_arm::vector_of(in.torque)};
  follow_base();
  const robotics::Pose base{base_.orientation().toRotationMatrix(), base_.position_m()};
  // A robot with masses always has an inertia; without one the last state stays, and the law's torques are bounded.
  static_cast<void>(floating_->update(base, measured_.position));
  tool_values_.store({three_of(floating_->tool().position), four_of(Quaternion{floating_->tool().rotation})});
  base_values_.store({three_of(base_.position_m()), four_of(base_.orientation())});
  conditioning_.store(floating_->conditioning());
}

/// The base goes on as the joints make it, without momentum, and samples set that right.
void FloatingArm::follow_base() noexcept {
  if (!tracks()) return base_.stand_still();
  if (!pose_.valid()) base_.forget();
  base_.go_on(floating_->base() * measured_.velocity, cycle_s_);
  const BasePose& sample = pose_.value();
  if (!pose_.valid() || pose_.age_cycles() != 0 || sample.quality == 0) return;
  const auto& wxyz = sample.orientation_wxyz;
  base_.take({sample.position_m[0], sample.position_m[1], sample.position_m[2]}, {wxyz[0], wxyz[1], wxyz[2], wxyz[3]});
}

/// Takes the present place as the reference: entering Operational moves nothing.
void FloatingArm::engage() noexcept {
  phase_ = Phase::Holds;
  joints_goal_ = joints_from_ = measured_.position;
  tool_goal_ = {floating_->tool(), Vector3::Zero()};
  base_kept_ = base_.orientation().toRotationMatrix();
  mean_left_m_.setZero();
  error_m_ = 0;
}

void FloatingArm::advance() noexcept {
  // The mean of the way that is left, not of its length: noise of the base's place has no direction.
  const Vector3 left = tool_goal_.pose.position - floating_->tool().position;
  mean_left_m_ += (left - mean_left_m_) * (cycle_s_ / error_filter_s);
  error_m_ = mean_left_m_.norm();
  if (phase_ == Phase::Holds) {
    tool_goal_.velocity_m_s.setZero();
    return;
  }
  moved_s_ += cycle_s_;
  const robot_arm::Course at = robot_arm::course(moved_s_, duration_s_);
  progress_.store(at.share);
  if (phase_ == Phase::ToolMoves) {
    tool_goal_.pose.position = tool_from_ + at.share * tool_offset_;
    tool_goal_.velocity_m_s = at.per_s * tool_offset_;
    const double conditioning = conditioning_.load();
    if (law_ == ToolLaw::AttitudeHold && conditioning < robot_arm::least_conditioning) {
      raise(conditioning_low_, conditioning);
      end_motion(Trouble::ill_conditioned, std::llround(1e3 * conditioning));
      braked_ = true;
      return;
    }
  }
  if (moved_s_ >= duration_s_) arrive();
}

/// The end of a path is not yet the goal: a motion is done when it is measured there.
void FloatingArm::arrive() noexcept {
  const bool there = phase_ == Phase::ToolMoves
                         ? error_m_ <= goal_tolerance_m_.load()
                         : (joints_goal_ - measured_.position).cwiseAbs().maxCoeff() <= joint_tolerance_rad;
  settled_s_ = there ? settled_s_ + cycle_s_ : 0;
  if (settled_s_ >= settled_enough_s) {
    raise(motion_done_);
    if (motion_) finish(*motion_);
    motion_.reset();
  } else if (moved_s_ > duration_s_ + patience_s) {
    end_motion(Trouble::goal_not_reached);
  } else {
    return;
  }
  if (phase_ == Phase::JointsMove) tool_goal_ = {floating_->tool(), Vector3::Zero()};
  else joints_goal_ = measured_.position;
  phase_ = Phase::Holds;
}

void FloatingArm::control() noexcept {
  if (phase_ == Phase::ToolMoves || (phase_ == Phase::Holds && tracks())) {
    wanted_rates_ =
        robot_arm::tool_rates(law_, *floating_, tool_goal_, base_.orientation().toRotationMatrix(), base_kept_);
  } else {
    const robot_arm::Course at =
        phase_ == Phase::JointsMove ? robot_arm::course(moved_s_, duration_s_) : robot_arm::Course{};
    const JointVector way = joints_goal_ - joints_from_;
    wanted_rates_ = at.per_s * way + joint_error_per_s * (joints_from_ + at.share * way - measured_.position);
  }
  robot_arm::slow_down(wanted_rates_, bounds_);
  device_.output().torque =
      robot_arm::joints_of(robot_arm::joint_torque(*floating_, wanted_rates_, measured_.velocity, bounds_));
  desired_velocity_.store(robot_arm::joints_of(wanted_rates_));
  phase_values_.store(static_cast<std::uint8_t>(braked_ ? Phase::Braked : phase_));
  constexpr double deg = 180 / std::numbers::pi;
  error_values_.store(
      {error_m_, deg * robot_arm::rotation_between(floating_->tool().rotation, tool_goal_.pose.rotation).norm()});
}

/// What else than its own sensors keeps it from moving.
bool FloatingArm::may_act() noexcept {
  if (!tracks()) return true;
  if (pose_.valid() && pose_.value().free == 0) {
    raise(base_held_);
    end_motion(Trouble::base_is_held);
    return false;
  }
  // It would begin to turn about as soon as it is let go.
  const double conditioning = conditioning_.load();
  if (law_ != ToolLaw::AttitudeHold || conditioning >= robot_arm::least_conditioning) return true;
  raise(conditioning_low_, conditioning);
  end_motion(Trouble::ill_conditioned, std::llround(1e3 * conditioning));
  return false;
}

/// Each limit is told once until the next entry into Operational; it stays in force when the actuators are inhibited.
void FloatingArm::watch() noexcept {
  const auto shares = limits_.load();
  const auto found =
      watch_.update(measured_, nullptr, bounds_,
                    {.speed_share = shares[2], .torque_share = shares[0], .torque_hard_share = shares[1]});
  if (watch_.tripped()) inhibit_actuators();
  if (!found) return;
  end_motion(Trouble::limit_tripped, static_cast<std::int64_t>(found->joint + 1));
  raise(found->what == robot_arm::Excess::TorqueHard ? hard_exceeded_ : limit_exceeded_,
        static_cast<std::uint8_t>(found->joint + 1), found->value, found->limit);
}

template <FailureEnumeration Code>
void FloatingArm::end_motion(Code why, std::int64_t number) noexcept {
  if (motion_) abort(*motion_, why, "", number);
  motion_.reset();
  if (phase_ == Phase::ToolMoves || phase_ == Phase::JointsMove) phase_ = Phase::Holds;
}

// --- functions ---------------------------------------------------------------------------------------------------------

Outcome FloatingArm::may_move() const noexcept {
  if (tracks() && pose_.valid() && pose_.value().free == 0) return refused(Trouble::base_is_held);
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (motion_ || phase_ != Phase::Holds) return refused(pus::FailureCode::Busy);
  return running;
}

void FloatingArm::begin(const Call& call, Phase phase, double duration_s) noexcept {
  motion_ = call;
  phase_ = phase;
  duration_s_ = duration_s;
  moved_s_ = settled_s_ = 0;
}

Outcome FloatingArm::move_joint(const FunctionValues& values, const Call& call) noexcept {
  if (tracks()) return refused(Trouble::another_law, "in the configuration JOINTS only");
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  const JointVector goal = robot_arm::vector_of(std::span{values}.first(bounds_.size()));
  const double duration_s = values[bounds_.size()];
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    if (!(goal[joint] >= bounds_[i].lowest && goal[joint] <= bounds_[i].highest))
      return refused(Trouble::out_of_range, "joint", static_cast<std::int64_t>(i + 1));
    const double fastest =
        robot_arm::fastest_of_course * std::abs(goal[joint] - measured_.position[joint]) / duration_s;
    if (!(fastest <= bounds_[i].motion.velocity))
      return refused(Trouble::too_fast, "joint", static_cast<std::int64_t>(i + 1));
  }
  begin(call, Phase::JointsMove, duration_s);
  joints_from_ = measured_.position;
  joints_goal_ = goal;
  return running;
}

Outcome FloatingArm::move_tool(const std::array<double, 3>& offset_m, double duration_s, const Call& call) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  const Vector3 offset{offset_m[0], offset_m[1], offset_m[2]};
  const double fastest = robot_arm::fastest_of_course * offset.norm() / duration_s;
  if (!(fastest <= tool_speed_m_s_.load())) return refused(Trouble::too_fast, "mm/s", std::llround(1e3 * fastest));
  begin(call, Phase::ToolMoves, duration_s);
  // One that stood by its joints begins where it is, one that kept its tool where that is to be.
  if (!tracks()) tool_goal_ = {floating_->tool(), Vector3::Zero()};
  tool_from_ = tool_goal_.pose.position;
  tool_offset_ = offset;
  return running;
}

void FloatingArm::bind_functions() {
  on_function("MOVE_JOINT", [this](const FunctionValues& values, Call call) { return move_joint(values, call); });
  on_function("MOVE_TOOL", [this](std::array<double, 3> offset_m, double duration_s, Call call) {
    return move_tool(offset_m, duration_s, call);
  });
  on_function("HOLD", [this]() -> Outcome {
    if (!moving_) return refused(Trouble::actuators_inhibited);
    end_motion(pus::FailureCode::Aborted);
    joints_goal_ = joints_from_ = measured_.position;
    tool_goal_ = {floating_->tool(), Vector3::Zero()};
    return ok();
  });
  on_function("BRAKE", [this]() -> Outcome {
    end_motion(pus::FailureCode::Aborted);
    braked_ = true;
    return ok();
  });
}

}  // namespace hirosco
