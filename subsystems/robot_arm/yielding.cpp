// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/yielding.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "subsystems/robot_arm/trouble.hpp"

namespace hirosco::robot_arm {
namespace {

/// An external torque has to last for a contact, so many cycles.
constexpr std::uint32_t contact_after_cycles = 3;
/// A load that stood is gone when so much of the limit is left of it.
constexpr double gone_share = 0.5;
/// In which it lets go of whoever it met.
constexpr double let_go_s = 0.05;
/// Of a joint's velocity: what is faster does not stand. Let go of, it goes on by that over FLOAT_DAMPING.
constexpr double standing_share = 0.05;

}  // namespace

void Yielding::engage() noexcept {
  parts_.guidance.engage();
  parts_.obstacles.tell(parts_.drives.measured().position);
  parts_.control.laws().reset();
  arm(Before::Counts);
}

/// The setpoint of whoever gave way is elsewhere than the arm: a hard law begins where the arm is, and so does any after it was led.
void Yielding::take_law(LawKind kind) noexcept {
  const Measured& measured = parts_.drives.measured();
  if (parts_.control.led() || (kind == LawKind::Position && parts_.control.gives_way()))
    parts_.guidance.setpoints().settle(measured.position, measured.velocity);
  if (kind == LawKind::Float) parts_.guidance.engage();
  const bool lets_go = kind == LawKind::Float || parts_.control.kind() == LawKind::Torque;
  parts_.control.laws().set(kind, lets_go ? let_go_s : Laws::smooth_s);
  arm(Before::Counts);
}

void Yielding::stand() noexcept {
  if (parts_.control.floats()) take_law(LawKind::Position);
  else parts_.guidance.setpoints().brake();
}

void Yielding::stand_apart() noexcept {
  take_law(LawKind::Position);
  stands_apart_ = true;
}

// --- a contact -----------------------------------------------------------------------------------------------------------

/// Of a load that stands no more is borne than the limit, and never so much that the torque limit had to find what comes to it: one motion
/// behind the other presses no harder than the first.
void Yielding::arm(Before load) noexcept {
  contact_cycles_ = 0;
  stands_apart_ = false;
  borne_.resize(0);
  if (load == Before::Counts) return;
  const double limit = parts_.parameters.contact.load().limit;
  const double most = std::min(limit, std::max(0.0, parts_.parameters.torque_limit.load() - limit));
  const Bounds bounds = parts_.known.bounds();
  borne_.setZero(static_cast<Eigen::Index>(bounds.size()));
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double share = parts_.model.external()[i] / bounds[joint].effort;
    if (std::abs(share) > limit) borne_[i] = std::clamp(share, -most, most);
  }
}

/// Away from where a load stood nothing more is let through than without it.
double Yielding::counts_from(Eigen::Index joint, double share, double limit) noexcept {
  if (borne_.size() == 0) return limit;
  double& borne = borne_[joint];
  if (share * (borne > 0 ? 1 : -1) < gone_share * limit) borne = 0;
  return limit + std::abs(borne);
}

std::optional<Yielding::Contact> Yielding::meet() noexcept {
  const ContactValues values = parts_.parameters.contact.load();
  if (values.reaction == static_cast<std::uint8_t>(Reaction::None)) return std::nullopt;
  const JointVector& external = parts_.model.external();
  const Bounds bounds = parts_.known.bounds();
  std::size_t worst = 0;
  double most = 0, limit = values.limit;
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double share = external[i] / bounds[joint].effort;
    const double its = counts_from(i, share, values.limit);
    if (std::abs(share) - its > most) most = std::abs(share) - its, worst = joint, limit = its;
  }
  if (most <= 0) {
    contact_cycles_ = 0;
    return std::nullopt;
  }
  if (++contact_cycles_ != contact_after_cycles || parts_.control.floats()) return std::nullopt;
  return Contact{worst, external[static_cast<Eigen::Index>(worst)], limit * bounds[worst].effort,
                 static_cast<std::uint8_t>(reaction())};
}

Yielding::Reaction Yielding::reaction() const noexcept {
  return stands_apart_ ? Reaction::Stop : static_cast<Reaction>(parts_.parameters.contact.load().reaction);
}

void Yielding::react(const Doing& doing) noexcept {
  const Reaction by = reaction();
  if (by == Reaction::Float && !doing.stopping) {
    take_law(LawKind::Float);
    return;
  }
  if (doing.stood) return;
  if (by == Reaction::Retract && !doing.stopping && !parts_.guidance.retracting()) {
    parts_.guidance.retract();
  } else {
    const Measured& measured = parts_.drives.measured();
    parts_.guidance.setpoints().halt(measured.position, measured.velocity);
  }
}

// --- functions -----------------------------------------------------------------------------------------------------------

Outcome Yielding::soften(LawKind kind, const Impedance& impedance) noexcept {
  Compliance& compliance = parts_.control.laws().compliance();
  const Joints rotor = parts_.parameters.rotor_inertia.load();
  if (const auto found =
          compliance.too_stiff(kind, impedance, parts_.model.dynamics(), rotor, parts_.control.bandwidth_rad_s()))
    return refused(Trouble::too_stiff, kind == LawKind::JointImpedance ? "joint" : "of the tool, 1-3 about, 4-6 along",
                   static_cast<std::int64_t>(*found + 1));
  compliance.set(impedance);
  take_law(kind);
  return ok();
}

Outcome Yielding::soften_joints(const FunctionValues& values) noexcept {
  const std::size_t joints = parts_.known.joints();
  Impedance impedance = parts_.control.laws().impedance();
  impedance.joint_n_m_rad = vector_of(std::span{values}.first(joints));
  impedance.damping_ratio = values[joints];
  return soften(LawKind::JointImpedance, impedance);
}

Outcome Yielding::soften_tool(double stiffness_n_m, double turning_n_m, double damping) noexcept {
  Impedance impedance = parts_.control.laws().impedance();
  impedance.tool_n_m = stiffness_n_m;
  impedance.tool_n_m_rad = turning_n_m;
  impedance.damping_ratio = damping;
  return soften(LawKind::ToolImpedance, impedance);
}

/// A setpoint that rests is not enough: springs may swing the arm, or somebody pushes it on.
std::optional<std::size_t> Yielding::still_moves() const noexcept {
  const JointVector& velocity = parts_.drives.measured().velocity;
  const Bounds bounds = parts_.known.bounds();
  for (std::size_t joint = 0; joint < bounds.size(); ++joint)
    // Written so that what is no number moves.
    if (!(std::abs(velocity[static_cast<Eigen::Index>(joint)]) <= standing_share * bounds[joint].motion.velocity))
      return joint;
  return std::nullopt;
}

Outcome Yielding::let_go() noexcept {
  if (parts_.control.floats()) return ok();
  if (const auto joint = still_moves())
    return refused(pus::FailureCode::Busy, "it moves yet and would go on: wait, joint",
                   static_cast<std::int64_t>(*joint + 1));
  take_law(LawKind::Float);
  return ok();
}

void Yielding::harden() noexcept {
  if (parts_.control.gives_way()) take_law(LawKind::Position);
}

}  // namespace hirosco::robot_arm
