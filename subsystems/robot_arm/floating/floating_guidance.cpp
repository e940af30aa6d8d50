// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_guidance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace hirosco::robot_arm {
namespace {

constexpr double joint_error_per_s = 5;
/// So long a goal has to be measured before it counts as reached, and at most so long after the end of the path.
constexpr double settled_enough_s = 0.1, patience_s = 10;
constexpr double joint_tolerance_rad = 1e-3;
/// Of the filter before the tool's error, which single samples of a star tracker would hide.
constexpr double error_filter_s = 0.5;
/// What the noise of the base's pose may bring links nearer to each other than where they are too near: the tool shakes by up to 0.42 mm (SV3). Who holds it,
/// where a motion was stopped for that, may come so much nearer once more before brakes hold him.
constexpr double shakes_m = 0.002;
/// Share of a course's time that it may stand at its beginning while its way is judged: what a second has in 64 cycles at 1 kHz. Where cycles are longer, it ends later.
constexpr double most_missed = 0.07;

[[nodiscard]] FloatingReason reason_of(const NoWayOut& none) noexcept {
  using Why = NoWayOut::Why;
  const FloatingTrouble trouble = none.why == Why::OutOfRange ? FloatingTrouble::out_of_range
                                  : none.why == Why::TooNear  ? FloatingTrouble::too_near
                                  : none.why == Why::TooSlow  ? FloatingTrouble::too_slow
                                                              : FloatingTrouble::no_goal;
  return {trouble, none.text, none.number};
}

[[nodiscard]] Outcome refused_for(const NoWayOut& none) noexcept {
  const FloatingReason why = reason_of(none);
  return refused(why.trouble, why.text, why.number);
}

}  // namespace

void FloatingGuidance::begin(double cycle_s) {
  cycle_s_ = cycle_s;
  way_.emplace(parts_.known.model(), parts_.known.tip());
  joints_goal_ = joints_from_ = parts_.drives.measured().position;
  out_.begin(cycle_s);
  end_motion();
  parts_.parameters.progress.store(0);
}

void FloatingGuidance::engage() noexcept {
  if (!out_.only_judges()) end_motion();
  base_let_go_ = true;
  come_to_hold();
  out_.forget_way();
  mean_left_m_.setZero();
  error_m_ = 0;
}

/// Whoever holds from here on keeps what is, of the base, too, where it has turned as it would; while it comes to rest yet it turns on.
void FloatingGuidance::stand() noexcept {
  joints_goal_ = joints_from_ = parts_.drives.measured().position;
  tool_goal_ = {parts_.craft.tool(), Vector3::Zero()};
  if (phase_ != Phase::Holds || !base_let_go_) return;
  base_kept_ = parts_.craft.attitude();
  base_let_go_ = false;
}

void FloatingGuidance::come_to_hold() noexcept {
  phase_ = Phase::Holds;
  stand();
}

void FloatingGuidance::end_motion() noexcept {
  phase_ = Phase::Holds;
  judges_ = Judges::Nothing;
  out_.end();
}

void FloatingGuidance::stop(const JointVector& rates) noexcept {
  end_motion();
  phase_ = Phase::Stops;
  stop_.begin(rates);
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

FloatingGuidance::News FloatingGuidance::advance() noexcept {
  // The mean of the way that is left, not of its length: noise of the base's place has no direction.
  const Vector3 left = tool_goal_.pose.position - parts_.craft.tool().position;
  mean_left_m_ += (left - mean_left_m_) * (cycle_s_ / error_filter_s);
  error_m_ = mean_left_m_.norm();
  if (!out_.goes()) out_.record();
  if (phase_ == Phase::Holds) {
    tool_goal_.velocity_m_s.setZero();
    if (out_.under_way()) return go_out();
    return judges_ == Judges::Nothing ? News::None : judge();
  }
  if (phase_ == Phase::Stops) {
    stop_.go_on(cycle_s_);
    if (stop_.over()) come_to_hold();
    else stand();
    return News::None;
  }
  if (phase_ == Phase::GoesOut) {
    // It is to be nowhere else: ERR tells of no way that nobody goes.
    tool_goal_ = {parts_.craft.tool(), Vector3::Zero()};
    return go_out();
  }
  moved_s_ += cycle_s_;
  const Course at = course(moved_s_, duration_s_);
  parts_.parameters.progress.store(at.share);
  if (phase_ == Phase::ToolMoves) {
    tool_goal_.pose.position = tool_from_ + at.share * tool_offset_;
    tool_goal_.velocity_m_s = at.per_s * tool_offset_;
    if (parts_.craft.law() == ToolLaw::AttitudeHold && parts_.parameters.conditioning.load() < least_conditioning)
      return News::IllConditioned;
  }
  return moved_s_ >= duration_s_ ? arrive() : News::None;
}

/// A step in a cycle, while it stands. Its course has begun with the telecommand, and is so flat there that it is joined where it has come to by then: of 26 mm in a
/// second, which is the most, 0.07 mm and 3 mm/s; of 0.2 m in 20 s a thousandth of that. Of joints likewise: of the 0.1 rad that are the most in a second 0.3 mrad and 12 mrad/s.
FloatingGuidance::News FloatingGuidance::judge() noexcept {
  moved_s_ = std::min(moved_s_ + cycle_s_, most_missed * duration_s_);
  const bool of_joints = judges_ == Judges::JointsWay;
  if (!(of_joints ? straight_.step() : way_->step(parts_.known.bounds()))) {
    judges_ = Judges::Nothing;
    phase_ = of_joints ? Phase::JointsMove : Phase::ToolMoves;
    if (of_joints) joints_from_ = straight_.from(), joints_goal_ = straight_.goal();
    return News::None;
  }
  const auto ahead = parts_.obstacles.near_on_way(parts_.drives.measured().position,
                                                  of_joints ? straight_.posture() : way_->posture(), shakes_m);
  if (!ahead) return News::None;
  if (of_joints) parts_.parameters.progress.store(straight_.share());
  return no_way({FloatingTrouble::too_near, ahead->names, millimetres(ahead->distance_m)});
}

FloatingGuidance::News FloatingGuidance::no_way(const FloatingReason& why) noexcept {
  why_ = why;
  return News::NoWay;
}

// --- out -----------------------------------------------------------------------------------------------------------------

/// Whatever takes the actuators away or stops the arm meanwhile ends this as it ends a motion.
FloatingGuidance::News FloatingGuidance::go_out() noexcept {
  const FloatingWayOut::At at = out_.step();
  if (out_.goes() && phase_ == Phase::Holds) {
    start(Phase::GoesOut, 0);
    base_let_go_ = true;
  }
  parts_.parameters.progress.store(out_.progress());
  switch (at) {
    case FloatingWayOut::At::OnWay: return News::None;
    case FloatingWayOut::At::Judged: out_.end(); return News::Judged;
    case FloatingWayOut::At::NoWay: return no_way(reason_of(out_.why()));
    case FloatingWayOut::At::Lost: come_to_hold(); return News::NotReached;
    case FloatingWayOut::At::Last: break;
  }
  moved_s_ += cycle_s_;
  joints_from_ = joints_goal_ = out_.now().position;
  return arrive();
}

// --- at its end ----------------------------------------------------------------------------------------------------------

/// The end of a path is not yet the goal: a motion is done when it is measured there.
FloatingGuidance::News FloatingGuidance::arrive() noexcept {
  const JointVector& measured = parts_.drives.measured().position;
  const bool there = phase_ == Phase::ToolMoves
                         ? error_m_ <= parts_.parameters.goal_tolerance_m.load()
                         : (joints_goal_ - measured).cwiseAbs().maxCoeff() <= joint_tolerance_rad;
  settled_s_ = there ? settled_s_ + cycle_s_ : 0;
  const bool reached = settled_s_ >= settled_enough_s;
  if (!reached && !(moved_s_ > duration_s_ + patience_s)) return News::None;
  const JointVector goal = joints_goal_;
  const Phase came_by = phase_;
  if (came_by == Phase::GoesOut) {
    out_.end();
    come_to_hold();
  }
  if (reached && came_by != Phase::ToolMoves) {
    joints_goal_ = goal;
    tool_goal_ = {parts_.craft.tool(), Vector3::Zero()};
  } else {
    joints_goal_ = measured;
  }
  phase_ = Phase::Holds;
  return reached ? News::Reached : News::NotReached;
}

bool FloatingGuidance::keeps_tool() const noexcept {
  return phase_ == Phase::ToolMoves || (phase_ == Phase::Holds && parts_.craft.tracks());
}

JointVector FloatingGuidance::wanted_rates() const noexcept {
  const FloatingCraft& craft = parts_.craft;
  JointVector rates;
  if (phase_ == Phase::Stops) {
    rates = stop_.rates();
  } else if (phase_ == Phase::GoesOut) {
    rates = out_.now().velocity + joint_error_per_s * (out_.now().position - parts_.drives.measured().position);
  } else if (keeps_tool()) {
    rates = tool_rates(craft.law(), craft.model(), parts_.known.bounds(), tool_goal_, craft.attitude(), base_kept_);
  } else {
    const Course at = phase_ == Phase::JointsMove ? course(moved_s_, duration_s_) : Course{};
    const JointVector way = joints_goal_ - joints_from_;
    rates = at.per_s * way + joint_error_per_s * (joints_from_ + at.share * way - parts_.drives.measured().position);
  }
  slow_down(rates, parts_.known.bounds());
  return rates;
}

std::optional<EndAhead> FloatingGuidance::end_ahead(const JointVector& rates) const noexcept {
  if (!keeps_tool() && phase_ != Phase::Stops) return std::nullopt;
  return robot_arm::end_ahead(parts_.drives.measured().position, rates, parts_.known.bounds());
}

std::optional<Obstacles::Nearest> FloatingGuidance::near_ahead(const JointVector& rates) noexcept {
  const Measured& measured = parts_.drives.measured();
  const JointVector ahead = measured.position + StopRamp::way(rates, measured.velocity, cycle_s_);
  return holds() ? parts_.obstacles.near_at(ahead, 2 * shakes_m)
                 : parts_.obstacles.near_on_way(measured.position, ahead, shakes_m);
}

void FloatingGuidance::tell(bool braked) noexcept {
  parts_.parameters.phase.store(static_cast<std::uint8_t>(braked ? Phase::Braked : phase_));
  constexpr double deg = 180 / std::numbers::pi;
  parts_.parameters.error.store(
      {error_m_, deg * rotation_between(parts_.craft.tool().rotation, tool_goal_.pose.rotation).norm()});
}

// --- functions -----------------------------------------------------------------------------------------------------------

void FloatingGuidance::start(Phase phase, double duration_s) noexcept {
  phase_ = phase;
  duration_s_ = duration_s;
  moved_s_ = settled_s_ = 0;
}

Outcome FloatingGuidance::move_joint(const FunctionValues& values) noexcept {
  const Bounds bounds = parts_.known.bounds();
  const JointVector& measured = parts_.drives.measured().position;
  const JointVector goal = vector_of(std::span{values}.first(bounds.size()));
  const double duration_s = values[bounds.size()];
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    if (!(goal[joint] >= bounds[i].lowest && goal[joint] <= bounds[i].highest))
      return refused(FloatingTrouble::out_of_range, "joint", static_cast<std::int64_t>(i + 1));
    const double fastest = fastest_of_course * std::abs(goal[joint] - measured[joint]) / duration_s;
    if (!(fastest <= bounds[i].motion.velocity))
      return refused(FloatingTrouble::too_fast, "joint", static_cast<std::int64_t>(i + 1));
  }
  if (const auto there = parts_.obstacles.nearer(measured, goal); there.distance_m != HUGE_VAL)
    return refused(FloatingTrouble::too_near, there.names, millimetres(there.distance_m));
  start(Phase::Holds, duration_s);
  parts_.parameters.progress.store(0);
  straight_.begin(measured, goal, cycle_s_);
  judges_ = Judges::JointsWay;
  return running;
}

Outcome FloatingGuidance::move_tool(const std::array<double, 3>& offset_m, double duration_s) noexcept {
  const Vector3 offset{offset_m[0], offset_m[1], offset_m[2]};
  const double fastest = fastest_of_course * offset.norm() / duration_s;
  if (!(fastest <= parts_.parameters.tool_speed_m_s.load()))
    return refused(FloatingTrouble::too_fast, "mm/s", std::llround(1e3 * fastest));
  start(Phase::Holds, duration_s);
  parts_.parameters.progress.store(0);
  // One that stood by its joints begins where it is, one that kept its tool where that is to be.
  if (!parts_.craft.tracks()) tool_goal_ = {parts_.craft.tool(), Vector3::Zero()};
  tool_from_ = tool_goal_.pose.position;
  tool_offset_ = offset;
  way_->begin({.law = parts_.craft.law(),
               .base = parts_.craft.base(),
               .base_kept = base_kept_,
               .position = parts_.drives.measured().position,
               .tool = tool_goal_.pose,
               .offset_m = offset,
               .duration_s = duration_s});
  judges_ = Judges::ToolsWay;
  return running;
}

Outcome FloatingGuidance::leave(FloatingWayOut::By by, double number) noexcept {
  if (stops()) {
    out_.wait(by, number);
    return running;
  }
  const auto none = out_.begin(by, number);
  return none ? refused_for(*none) : running;
}

Outcome FloatingGuidance::check_abort() noexcept {
  if (!out_.begun()) return refused(pus::FailureCode::NotPermittedNow);
  const auto none = out_.check_abort();
  return none ? refused_for(*none) : running;
}

}  // namespace hirosco::robot_arm
