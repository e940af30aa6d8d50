// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/abort_motion.hpp"

#include <algorithm>

#include "subsystems/robot_arm/control/trail.hpp"

namespace hirosco::robot_arm {
namespace {

/// A setpoint that is no farther from a posture has gone there.
constexpr double at_posture = 1e-6;
constexpr const char* would_last_as_usual = "without a SPEED it would take longer, s";

}  // namespace

void AbortMotion::begin(AbortWay::Judged what, double speed_share) noexcept {
  phase_ = Phase::Judged;
  what_ = what;
  speed_share_ = speed_share;
  gone_s_ = duration_s_ = 0;
}

AbortMotion::At AbortMotion::step(Setpoints& setpoints) noexcept {
  if (phase_ == Phase::Judged) return judge(setpoints);
  if (!setpoints.at_rest()) return At::OnWay;
  const AbortWay& way = path_.way();
  if (apart(setpoints.now().position, way.posture(posture_)) > at_posture) return At::Lost;
  if (posture_ + 1 == way.size()) return At::Last;
  gone_s_ += setpoints.duration_s();
  ++posture_;
  return go(setpoints) ? At::OnWay : At::Lost;
}

AbortMotion::At AbortMotion::judge(Setpoints& setpoints) noexcept {
  switch (path_.judge()) {
    case AbortWay::Found::NotYet: return At::OnWay;
    case AbortWay::Found::Way: return set_out(setpoints);
    case AbortWay::Found::Nothing:
    case AbortWay::Found::TooLong: break;
  }
  return no_way(path_.why());
}

/// Of a path that is judged alone it is seen whether a telecommand could wait for it; the other one goes.
AbortMotion::At AbortMotion::set_out(Setpoints& setpoints) noexcept {
  const AbortWay& way = path_.way();
  const bool goes = what_ == AbortWay::Judged::FromHere;
  posture_ = way.joined();
  duration_s_ = goes ? setpoints.duration_s(way.here(), way.posture(posture_), speed_share_) : 0;
  for (std::size_t i = posture_ + 1; i < way.size(); ++i)
    duration_s_ += setpoints.duration_s(way.posture(i - 1), way.posture(i), speed_share_);
  if (duration_s_ > longest_s_)
    return no_way(
        {NoWayOut::Why::TooSlow, goes ? would_last : would_last_as_usual, static_cast<std::int64_t>(longest_s_)});
  if (!goes) return At::Judged;
  phase_ = Phase::Goes;
  return go(setpoints) ? At::OnWay : no_way({NoWayOut::Why::NoPath, "it is no place"});
}

AbortMotion::At AbortMotion::no_way(const NoWayOut& why) noexcept {
  why_ = why;
  return At::NoWay;
}

bool AbortMotion::go(Setpoints& setpoints) noexcept {
  path_.tell(posture_ + 1);
  return setpoints.go(path_.way().posture(posture_), speed_share_).has_value();
}

double AbortMotion::progress(const Setpoints& setpoints) const noexcept {
  if (duration_s_ <= 0) return setpoints.progress();
  return std::min(1.0, (gone_s_ + setpoints.progress() * setpoints.duration_s()) / duration_s_);
}

}  // namespace hirosco::robot_arm
