// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_motions.hpp"

#include <cmath>
#include <span>

#include "subsystems/robot_arm/control/power_pace.hpp"

namespace hirosco::robot_arm {
namespace {

constexpr const char* springs_of_tool = "springs hold its tool: POSITION_CONTROL first";
constexpr const char* springs_of_joints = "springs hold its joints: POSITION_CONTROL first";

[[nodiscard]] Outcome refused_for(const NoWayOut& none) noexcept {
  const FloatingReason why = reason_of(none);
  return refused(why.trouble, why.text, why.number);
}

}  // namespace

/// Springs have a course begin where they have it, and not where somebody has pushed it.
JointVector FloatingMotions::from() const noexcept {
  return soft() ? joints_.goal() : parts_.drives.measured().position;
}

/// A course in so long goes no slower for its power: it is refused.
Outcome FloatingMotions::move_joint(const FunctionValues& values) noexcept {
  const std::size_t joints = parts_.known.joints();
  const JointVector goal = vector_of(std::span{values}.first(joints));
  if (law() == LawKind::ToolImpedance) return refused(FloatingTrouble::soft, springs_of_tool);
  PowerPace pace;
  pace.set(JointVector::Zero(goal.size()), parts_.known.bounds(), parts_.parameters.power_limit_w.load());
  const JointVector fastest = fastest_of_course / values[joints] * (goal - from());
  if (pace.share(fastest) < 1)
    return refused(FloatingTrouble::too_fast, "W of all joints it may take", std::llround(pace.power(fastest)));
  if (const auto why = before_.judge(from(), goal, values[joints]))
    return refused(why->trouble, why->text, why->number);
  start(Phase::Holds, values[joints]);
  parts_.parameters.progress.store(0);
  return running;
}

Outcome FloatingMotions::move_tool(const std::array<double, 3>& offset_m, double duration_s) noexcept {
  if (law() == LawKind::JointImpedance) return refused(FloatingTrouble::soft, springs_of_joints);
  const PreferredPosture preferred = parts_.posture.preferred();
  if (const auto why = parts_.posture.unfit(preferred))
    return refused(FloatingTrouble::out_of_range, why->text, why->number);
  const Vector3 offset{offset_m[0], offset_m[1], offset_m[2]};
  const double fastest = fastest_of_course * offset.norm() / duration_s;
  if (!(fastest <= parts_.parameters.tool_speed_m_s.load()))
    return refused(FloatingTrouble::too_fast, "mm/s", std::llround(1e3 * fastest));
  start(Phase::Holds, duration_s);
  parts_.parameters.progress.store(0);
  // One that stood by its joints begins where it is, one that kept its tool where that is to be.
  if (!parts_.craft.tracks() && !soft()) kept_.keep();
  kept_.begin_course(offset, duration_s, preferred);
  before_.judge({.law = parts_.craft.law(),
                 .base = parts_.craft.base(),
                 .base_kept = kept_.base(),
                 .position = parts_.drives.measured().position,
                 .tool = kept_.goal().pose,
                 .offset_m = offset,
                 .duration_s = duration_s,
                 .preferred = preferred});
  return running;
}

Outcome FloatingMotions::jog_joints(const FunctionValues& values) noexcept {
  if (law() == LawKind::ToolImpedance) return refused(FloatingTrouble::soft, springs_of_tool);
  const JointVector begins = from();
  phase_ = Phase::JointsJog;
  return jog_.joints(values, begins);
}

Outcome FloatingMotions::drive(const FunctionValues& values) noexcept {
  if (const auto why = drive_.want(values, driven())) return refused(why->trouble, why->text, why->number);
  if (!driven()) start(Phase::Driven, 0);
  kept_.let_base_go();
  return running;
}

Outcome FloatingMotions::jog_tool(const std::array<double, 3>& moving_m_s, const std::array<double, 3>& turning_rad_s,
                                  double span_s) noexcept {
  if (law() == LawKind::JointImpedance) return refused(FloatingTrouble::soft, springs_of_joints);
  const Outcome begun = jog_.tool(moving_m_s, turning_rad_s, span_s);
  if (begun.kind == Outcome::Kind::Refused) return begun;
  if (!jogs_tool() && !parts_.craft.tracks() && !soft()) kept_.keep();
  phase_ = Phase::ToolJogs;
  return begun;
}

Outcome FloatingMotions::follow(Lead& lead) noexcept {
  if (law() == LawKind::ToolImpedance) return refused(FloatingTrouble::soft, springs_of_tool);
  setpoints().rest(from());
  if (const auto none = lead.follow(setpoints())) return refused(FloatingTrouble::not_led, none->text, none->number);
  phase_ = Phase::Follows;
  return ok();
}

Outcome FloatingMotions::follow(FloatingToolLead& lead) noexcept {
  if (law() == LawKind::JointImpedance) return refused(FloatingTrouble::soft, springs_of_joints);
  if (!parts_.craft.tracks() && !soft()) kept_.keep();
  if (const auto none = lead.follow(kept_.goal().pose))
    return refused(FloatingTrouble::not_led, none->text, none->number);
  phase_ = Phase::ToolFollows;
  return ok();
}

void FloatingMotions::lead_tool(const Vector3& turning_rad_s, const Vector3& moving_m_s, bool over) noexcept {
  kept_.lead(turning_rad_s, moving_m_s, cycle_s_, soft() ? KeptTool::Leash::Goes : KeptTool::Leash::Waits);
  if (!over) return;
  joints_.keep();
  phase_ = Phase::Holds;
}

Outcome FloatingMotions::leave(FloatingWayOut::By by, double number) noexcept {
  if (stops()) {
    out_.wait(by, number);
    return running;
  }
  const auto none = out_.begin(by, number);
  return none ? refused_for(*none) : running;
}

Outcome FloatingMotions::check_abort() noexcept {
  if (!out_.begun()) return refused(pus::FailureCode::NotPermittedNow);
  const auto none = out_.check_abort();
  return none ? refused_for(*none) : running;
}

}  // namespace hirosco::robot_arm
