// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_way_out.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

/// As long as MOVE_JOINT may take.
constexpr double longest_way_s = 120;
/// With which MOVE_ABORT goes unless it is told another one: who says that a path is free says it of this.
constexpr double usual_speed_share = 0.5;
/// Of its way back; 1.2 rad at a tenth of a rad/s are 12 s.
constexpr Setpoints::WayBack back{.speed_share = 0.5, .longest_s = 60};

}  // namespace

FloatingWayOut::FloatingWayOut(const Parts& parts) noexcept : parts_{parts}, abort_{parts.abort_path, longest_way_s} {}

void FloatingWayOut::begin(double cycle_s) {
  setpoints_.emplace(parts_.known.model(), parts_.known.tip(), parts_.known.bounds(), cycle_s, back);
  parts_.abort_path.begin_cycles(cycle_s);
  end();
  retreated_.reset();
  forget_way();
}

void FloatingWayOut::forget_way() noexcept { setpoints_->begin(parts_.drives.measured().position); }

void FloatingWayOut::record() noexcept { setpoints_->pass(parts_.drives.measured().position); }

std::optional<NoWayOut> FloatingWayOut::begin(By by, double number) noexcept {
  const JointVector stands = JointVector::Zero(parts_.drives.measured().position.size());
  return by == By::WayBack ? retreat(number, stands) : judge(AbortWay::Judged::FromHere, number);
}

bool FloatingWayOut::retract(double distance) noexcept { return !retreat(distance, parts_.drives.measured().velocity); }

std::optional<NoWayOut> FloatingWayOut::check_abort() noexcept {
  return judge(AbortWay::Judged::PathAlone, usual_speed_share);
}

std::optional<NoWayOut> FloatingWayOut::retreat(double distance, const JointVector& velocity) noexcept {
  const JointVector here = parts_.drives.measured().position;
  setpoints_->retract(here, velocity, distance);
  if (setpoints_->kind() != Setpoints::Kind::Retract) {
    setpoints_->rest(here);
    return NoWayOut{NoWayOut::Why::NoPath, "it came here by no way since it entered Operational"};
  }
  retreat_ = distance;
  retreats_ = true;
  retreat_told_ = false;
  return std::nullopt;
}

std::optional<NoWayOut> FloatingWayOut::judge(AbortWay::Judged what, double speed_share) noexcept {
  if (const auto none = parts_.abort_path.begin(parts_.drives.measured().position, what)) return none;
  abort_.begin(what, speed_share);
  return std::nullopt;
}

FloatingWayOut::At FloatingWayOut::step() noexcept {
  if (waiting_) {
    const Waiting waited = *std::exchange(waiting_, std::nullopt);
    const auto none = begin(waited.by, waited.number);
    return none ? no_way(*none) : At::OnWay;
  }
  if (goes()) static_cast<void>(setpoints_->advance());
  if (retreats_) return step_back();
  switch (abort_.step(*setpoints_)) {
    case AbortMotion::At::OnWay: break;
    case AbortMotion::At::Judged: return At::Judged;
    case AbortMotion::At::Last: return At::Last;
    case AbortMotion::At::Lost: return At::Lost;
    case AbortMotion::At::NoWay: return no_way(abort_.why());
  }
  return At::OnWay;
}

FloatingWayOut::At FloatingWayOut::step_back() noexcept {
  if (!setpoints_->at_rest()) return At::OnWay;
  if (!retreat_told_) retreated_ = setpoints_->retracted_by();
  retreat_told_ = true;
  return setpoints_->retreated() ? At::Last : At::Lost;
}

FloatingWayOut::At FloatingWayOut::no_way(const NoWayOut& why) noexcept {
  why_ = why;
  return At::NoWay;
}

double FloatingWayOut::progress() const noexcept {
  // As far as its way is known may be less than it was to go.
  if (retreats_ && setpoints_->at_rest() && setpoints_->retreated()) return 1;
  if (retreats_) return std::min(1.0, setpoints_->retracted_by() / retreat_);
  return abort_.goes() ? abort_.progress(*setpoints_) : 0;
}

}  // namespace hirosco::robot_arm
