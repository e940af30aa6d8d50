// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "subsystems/robot_arm/robot_arm.hpp"

/// How an arm gives way: what it does about a contact, and laws that are soft (adr 0117).
namespace hirosco {

using robot_arm::JointVector;
using robot_arm::LawKind;

namespace {

/// An external torque has to last for a contact, so many cycles.
constexpr std::uint32_t contact_after_cycles = 3;
/// In which it lets go of whoever it met.
constexpr double let_go_s = 0.05;
/// Of what gives way it is looked where it would be after this time.
constexpr double ahead_s = 0.1;

}  // namespace

void RobotArm::watch_contact() noexcept {
  const robot_arm::ContactValues values = contact_values_.load();
  if (values.reaction == static_cast<std::uint8_t>(Reaction::None)) return;
  const JointVector& external = observer_->external();
  std::size_t worst = 0;
  double most = 0;
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const double share = std::abs(external[static_cast<Eigen::Index>(i)]) / bounds_[i].effort;
    if (share > most) most = share, worst = i;
  }
  if (most <= values.limit) {
    contact_cycles_ = 0;
    return;
  }
  if (++contact_cycles_ != contact_after_cycles || floats()) return;
  raise(contact_, static_cast<std::uint8_t>(worst + 1), external[static_cast<Eigen::Index>(worst)],
        values.limit * bounds_[worst].effort, values.reaction);
  react();
}

/// Whoever asked for a motion is told that it ended. Who backs off and meets somebody else stands; so does who is stopped, and who
/// stood: it is not he who went there.
void RobotArm::react() noexcept {
  const auto reaction = static_cast<Reaction>(contact_values_.load().reaction);
  const bool stood = setpoints_->at_rest() && !motion_;
  end_motion(Trouble::contact);
  if (reaction == Reaction::Float && !stop_) {
    take_law(LawKind::Float);
    return;
  }
  if (stood) return;
  if (reaction == Reaction::Retract && !stop_ && !retracting_) {
    setpoints_->retract(measured_.position, measured_.velocity, retract_distance_.load());
    retracting_ = true;
  } else {
    setpoints_->halt(measured_.position, measured_.velocity);
  }
}

void RobotArm::end_retract() noexcept {
  if (!retracting_ || !setpoints_->at_rest()) return;
  retracting_ = false;
  raise(retracted_, setpoints_->retracted_by());
}

/// Who is led stands where links, or one of them and what it is to keep out of, would meet.
void RobotArm::watch_yielding() noexcept {
  if (!laws_->gives_way()) return;
  const double now_m = clearance_->nearest(measured_.position).distance_m;
  if (floats()) clearance_m_.store(now_m);
  const auto ahead = clearance_->nearest(measured_.position + ahead_s * measured_.velocity);
  if (ahead.distance_m >= clearance_limit_m_.load() || ahead.distance_m >= now_m) return;
  raise(too_near_, ahead.distance_m);
  if (motion_) abort(*motion_, Trouble::too_near, ahead.names);
  motion_.reset();
  jog_left_s_ = 0;
  take_law(LawKind::Position);
}

/// The setpoint of whoever gave way is elsewhere than the arm: a hard law begins where the arm is, and so does any after it was led.
void RobotArm::take_law(LawKind kind) noexcept {
  if (floats() || (kind == LawKind::Position && laws_->gives_way()))
    setpoints_->settle(measured_.position, measured_.velocity);
  if (kind == LawKind::Float) setpoints_->begin(measured_.position), retracting_ = false;
  laws_->set(kind, kind == LawKind::Float ? let_go_s : robot_arm::Laws::smooth_s);
  contact_cycles_ = 0;
}

void RobotArm::stand() noexcept {
  if (floats()) take_law(LawKind::Position);
  else setpoints_->brake();
}

// --- functions ---------------------------------------------------------------------------------------------------------

Outcome RobotArm::soften(LawKind kind, const robot_arm::Impedance& impedance) noexcept {
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (motion_ || stop_ || !setpoints_->at_rest()) return refused(pus::FailureCode::Busy);
  const robot_arm::Joints rotor = rotor_inertia_.load();
  if (const auto found = laws_->compliance().too_stiff(kind, impedance, *dynamics_, rotor, bandwidth_rad_s_.load()))
    return refused(Trouble::too_stiff, kind == LawKind::JointImpedance ? "joint" : "of the tool, 1-3 about, 4-6 along",
                   static_cast<std::int64_t>(*found + 1));
  laws_->compliance().set(impedance);
  take_law(kind);
  return ok();
}

Outcome RobotArm::harden() noexcept {
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (motion_ || stop_ || !setpoints_->at_rest()) return refused(pus::FailureCode::Busy);
  if (laws_->gives_way()) take_law(LawKind::Position);
  return ok();
}

/// What the descriptor does not offer, this arm does not have.
void RobotArm::bind_laws() {
  const auto offered = [&](const char* name) { return own_descriptor().find_function(name) != nullptr; };
  if (offered("IMPEDANCE_J"))
    on_function("IMPEDANCE_J", [this](const FunctionValues& values, Call) -> Outcome {
      if (!laws_) return refused(pus::FailureCode::NotPermittedNow);
      robot_arm::Impedance impedance = laws_->impedance();
      impedance.joint_n_m_rad = robot_arm::vector_of(std::span{values}.first(bounds_.size()));
      impedance.damping_ratio = values[bounds_.size()];
      return soften(LawKind::JointImpedance, impedance);
    });
  if (offered("IMPEDANCE_L"))
    on_function("IMPEDANCE_L", [this](double stiffness_n_m, double turning_n_m, double damping) -> Outcome {
      if (!laws_) return refused(pus::FailureCode::NotPermittedNow);
      robot_arm::Impedance impedance = laws_->impedance();
      impedance.tool_n_m = stiffness_n_m;
      impedance.tool_n_m_rad = turning_n_m;
      impedance.damping_ratio = damping;
      return soften(LawKind::ToolImpedance, impedance);
    });
  if (offered("POSITION_CONTROL")) on_function("POSITION_CONTROL", [this]() { return harden(); });
}

}  // namespace hirosco
