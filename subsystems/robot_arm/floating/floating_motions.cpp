// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_motions.hpp"

#include <cmath>
#include <span>

namespace hirosco::robot_arm {
namespace {

[[nodiscard]] Outcome refused_for(const NoWayOut& none) noexcept {
  const FloatingReason why = reason_of(none);
  return refused(why.trouble, why.text, why.number);
}

}  // namespace

Outcome FloatingMotions::move_joint(const FunctionValues& values) noexcept {
  const std::size_t joints = parts_.known.joints();
  if (const auto why = before_.judge(vector_of(std::span{values}.first(joints)), values[joints]))
    return refused(why->trouble, why->text, why->number);
  start(Phase::Holds, values[joints]);
  parts_.parameters.progress.store(0);
  return running;
}

Outcome FloatingMotions::move_tool(const std::array<double, 3>& offset_m, double duration_s) noexcept {
  const Vector3 offset{offset_m[0], offset_m[1], offset_m[2]};
  const double fastest = fastest_of_course * offset.norm() / duration_s;
  if (!(fastest <= parts_.parameters.tool_speed_m_s.load()))
    return refused(FloatingTrouble::too_fast, "mm/s", std::llround(1e3 * fastest));
  start(Phase::Holds, duration_s);
  parts_.parameters.progress.store(0);
  // One that stood by its joints begins where it is, one that kept its tool where that is to be.
  if (!parts_.craft.tracks()) kept_.keep();
  kept_.begin_course(offset);
  before_.judge({.law = parts_.craft.law(),
                 .base = parts_.craft.base(),
                 .base_kept = kept_.base(),
                 .position = parts_.drives.measured().position,
                 .tool = kept_.goal().pose,
                 .offset_m = offset,
                 .duration_s = duration_s});
  return running;
}

Outcome FloatingMotions::jog_joints(const FunctionValues& values) noexcept {
  phase_ = Phase::JointsJog;
  return jog_.joints(values);
}

Outcome FloatingMotions::jog_tool(const std::array<double, 3>& moving_m_s, const std::array<double, 3>& turning_rad_s,
                                  double span_s) noexcept {
  const Outcome begun = jog_.tool(moving_m_s, turning_rad_s, span_s);
  if (begun.kind == Outcome::Kind::Refused) return begun;
  if (!jogs_tool() && !parts_.craft.tracks()) kept_.keep();
  phase_ = Phase::ToolJogs;
  return begun;
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
