// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/yielding.hpp"

#include <span>

#include "subsystems/robot_arm/control/standing.hpp"
#include "subsystems/robot_arm/trouble.hpp"

namespace hirosco::robot_arm {
namespace {

/// In which it lets go of whoever it met.
constexpr double let_go_s = 0.05;

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

void Yielding::arm(Before load) noexcept {
  stands_apart_ = false;
  felt_.arm(load, parts_.model.external(), parts_.known.bounds(),
            {.contact = parts_.parameters.contact.load().limit, .torque = parts_.parameters.torque_limit.load()});
}

std::optional<Yielding::Contact> Yielding::meet() noexcept {
  const ContactValues values = parts_.parameters.contact.load();
  if (values.reaction == static_cast<std::uint8_t>(Reaction::None)) return std::nullopt;
  const auto met = felt_.meet(parts_.model.external(), parts_.known.bounds(), values.limit);
  if (!met || parts_.control.floats()) return std::nullopt;
  return Contact{*met, static_cast<std::uint8_t>(reaction())};
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

Outcome Yielding::let_go() noexcept {
  if (parts_.control.floats()) return ok();
  if (const auto joint = still_moves(parts_.drives.measured().velocity, parts_.known.bounds()))
    return refused(pus::FailureCode::Busy, "it moves yet and would go on: wait, joint",
                   static_cast<std::int64_t>(*joint + 1));
  take_law(LawKind::Float);
  return ok();
}

void Yielding::harden() noexcept {
  if (parts_.control.gives_way()) take_law(LawKind::Position);
}

}  // namespace hirosco::robot_arm
