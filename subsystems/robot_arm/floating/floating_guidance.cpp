// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_guidance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hirosco::robot_arm {
namespace {

/// So long a goal has to be measured before it counts as reached, and at most so long after the end of the path.
constexpr double settled_enough_s = 0.1, patience_s = 10;
/// As hard it is stopped where it meets somebody, of the accelerations of motions: as the arm that stands.
constexpr double halting = 4;
/// Share of a course's time that it may stand at its beginning while its way is judged: what a second has in 64 cycles at 1 kHz. Where cycles are longer, it ends later.
constexpr double most_missed = 0.07;

}  // namespace

void FloatingGuidance::begin(double cycle_s) {
  cycle_s_ = cycle_s;
  before_.begin(cycle_s);
  joints_.keep();
  out_.begin(cycle_s);
  jog_.begin(cycle_s);
  drive_.begin(cycle_s);
  held_by_ = LawKind::Position;
  end_motion();
  parts_.parameters.progress.store(0);
}

void FloatingGuidance::engage() noexcept {
  if (!out_.only_judges()) end_motion();
  held_by_ = LawKind::Position;
  kept_.let_base_go();
  come_to_hold();
  out_.forget_way();
  kept_.forget_error();
}

/// Whoever holds from here on keeps what is, of the base, too, where it has turned as it would; while it comes to rest yet it turns on.
void FloatingGuidance::stand() noexcept {
  joints_.keep();
  kept_.keep();
  if (phase_ == Phase::Holds) kept_.keep_base();
}

void FloatingGuidance::come_to_hold() noexcept {
  phase_ = Phase::Holds;
  stand();
}

void FloatingGuidance::end_motion() noexcept {
  phase_ = Phase::Holds;
  before_.end();
  out_.end();
  jog_.end();
  drive_.end();
  stands_behind_drive_ = false;
}

void FloatingGuidance::stop(const JointVector& rates, double span_s) noexcept {
  end_motion();
  phase_ = Phase::Stops;
  stop_.begin(rates, span_s);
}

void FloatingGuidance::halt() noexcept {
  const JointVector rates = parts_.drives.measured().velocity;
  stop(rates, std::max(cycle_s_, StopRamp::span_of(rates, parts_.known.bounds(), halting)));
}

void FloatingGuidance::retract(double distance) noexcept {
  end_motion();
  if (!out_.retract(distance)) return halt();
  start(Phase::GoesOut, 0);
  kept_.let_base_go();
}

void FloatingGuidance::let_go() noexcept {
  end_motion();
  phase_ = Phase::Floats;
  held_by_ = LawKind::Position;
  kept_.let_base_go();
}

void FloatingGuidance::hold_by(LawKind kind) noexcept {
  if (kind != held_by_) stand();
  held_by_ = kind;
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

FloatingGuidance::News FloatingGuidance::advance() noexcept {
  kept_.measure(cycle_s_);
  const double most_w = parts_.parameters.power_limit_w.load();
  jog_.keep_power(most_w);
  out_.keep_power(most_w);
  if (!out_.goes()) out_.record();
  if (phase_ == Phase::Holds) {
    kept_.rest();
    if (out_.under_way()) return go_out();
    return before_.under_way() ? judge() : News::None;
  }
  if (stops()) return come_to_rest();
  if (phase_ == Phase::GoesOut) {
    // It is to be nowhere else: ERR tells of no way that nobody goes.
    kept_.keep();
    return go_out();
  }
  if (floats() || driven()) {
    stand();
    out_.forget_way();
    if (floats() || drive_.step()) return News::None;
    halt();
    stands_behind_drive_ = true;
    return News::None;
  }
  if (jogs_joints() || jogs_tool() || follows()) return jog_on();
  if (follows_tool()) return News::None;
  moved_s_ += cycle_s_;
  const Course at = course(moved_s_, duration_s_);
  parts_.parameters.progress.store(at.share);
  if (phase_ == Phase::ToolMoves) {
    kept_.go(at);
    if (parts_.craft.law() == ToolLaw::AttitudeHold && parts_.parameters.conditioning.load() < least_conditioning)
      return News::IllConditioned;
  }
  return moved_s_ >= duration_s_ ? arrive() : News::None;
}

FloatingGuidance::News FloatingGuidance::come_to_rest() noexcept {
  stop_.go_on(cycle_s_);
  if (!stop_.over()) {
    stand();
    return News::None;
  }
  come_to_hold();
  return std::exchange(stands_behind_drive_, false) ? News::Reached : News::None;
}

/// A step in a cycle, while it stands. Its course has begun with the telecommand, and is so flat there that it is joined where it has come to by then: of 26 mm in a
/// second, which is the most, 0.07 mm and 3 mm/s; of 0.2 m in 20 s a thousandth of that. Of joints likewise: of the 0.1 rad that are the most in a second 0.3 mrad and 12 mrad/s.
FloatingGuidance::News FloatingGuidance::judge() noexcept {
  moved_s_ = std::min(moved_s_ + cycle_s_, most_missed * duration_s_);
  const bool of_joints = before_.of_joints();
  switch (before_.step()) {
    case FloatingBeforehand::Found::NotYet: return News::None;
    case FloatingBeforehand::Found::JointsMayGo:
      phase_ = Phase::JointsMove;
      joints_.begin_course(before_.joints().from(), before_.joints().goal());
      return News::None;
    case FloatingBeforehand::Found::ToolMayGo: phase_ = Phase::ToolMoves; return News::None;
    case FloatingBeforehand::Found::Blocked: break;
  }
  if (of_joints) parts_.parameters.progress.store(before_.joints().share());
  const Obstacles::Nearest& near = before_.near();
  why_ = {FloatingTrouble::too_near, near.names, millimetres(near.distance_m)};
  return News::NoWay;
}

// --- jogged --------------------------------------------------------------------------------------------------------------

FloatingGuidance::News FloatingGuidance::jog_on() noexcept {
  const bool followed = follows();
  if (!followed) jog_.advance();
  if (jog_.of_tool())
    kept_.lead(jog_.turning(), jog_.moving(), cycle_s_, soft() ? KeptTool::Leash::Goes : KeptTool::Leash::Waits);
  if (followed ? !jog_.setpoints().at_rest() : !jog_.over()) return News::None;
  const bool of_joints = followed || jog_.of_joints();
  joints_.keep(of_joints ? jog_.now().position : parts_.drives.measured().position);
  if (of_joints) kept_.keep();
  jog_.end();
  phase_ = Phase::Holds;
  return followed ? News::None : News::Reached;
}

// --- out -----------------------------------------------------------------------------------------------------------------

/// Whatever takes the actuators away or stops the arm meanwhile ends this as it ends a motion.
FloatingGuidance::News FloatingGuidance::go_out() noexcept {
  const FloatingWayOut::At at = out_.step();
  if (out_.goes() && phase_ == Phase::Holds) {
    start(Phase::GoesOut, 0);
    kept_.let_base_go();
  }
  parts_.parameters.progress.store(out_.progress());
  switch (at) {
    case FloatingWayOut::At::OnWay: return News::None;
    case FloatingWayOut::At::Judged: out_.end(); return News::Judged;
    case FloatingWayOut::At::NoWay: why_ = reason_of(out_.why()); return News::NoWay;
    case FloatingWayOut::At::Lost: come_to_hold(); return News::NotReached;
    case FloatingWayOut::At::Last: break;
  }
  moved_s_ += cycle_s_;
  joints_.keep(out_.now().position);
  return arrive();
}

// --- at its end ----------------------------------------------------------------------------------------------------------

/// The end of a path is not yet the goal: a motion is done when it is measured there; of who gives way, when that is where springs are to have it.
FloatingGuidance::News FloatingGuidance::arrive() noexcept {
  const bool of_tool = phase_ == Phase::ToolMoves;
  const bool there =
      soft() || (of_tool ? kept_.error_m() <= parts_.parameters.goal_tolerance_m.load() : joints_.there());
  settled_s_ = there ? settled_s_ + cycle_s_ : 0;
  const bool reached = settled_s_ >= settled_enough_s;
  if (!reached && !(moved_s_ > duration_s_ + patience_s)) return News::None;
  const JointVector goal = joints_.goal();
  if (phase_ == Phase::GoesOut) {
    out_.end();
    come_to_hold();
  }
  if (reached && !of_tool) {
    joints_.keep(goal);
    kept_.keep();
  } else {
    joints_.keep();
  }
  phase_ = Phase::Holds;
  return reached ? News::Reached : News::NotReached;
}

bool FloatingGuidance::keeps_tool() const noexcept {
  return phase_ == Phase::ToolMoves || jogs_tool() || follows_tool() ||
         (phase_ == Phase::Holds && parts_.craft.tracks());
}

JointVector FloatingGuidance::wanted_rates() const noexcept {
  JointVector rates;
  if (phase_ == Phase::Stops) {
    rates = stop_.rates();
  } else if (gives_way()) {
    rates = parts_.drives.measured().velocity;
  } else if (phase_ == Phase::GoesOut) {
    rates = joints_.rates(out_.now());
  } else if (jogs_joints() || follows()) {
    rates = joints_.rates(jog_.now());
  } else if (keeps_tool()) {
    rates = kept_.rates(parts_.known.bounds());
  } else {
    rates = joints_.rates(phase_ == Phase::JointsMove ? course(moved_s_, duration_s_) : Course{});
  }
  slow_down(rates, parts_.known.bounds());
  return rates;
}

SoftGoal FloatingGuidance::goal() const noexcept {
  if (jogs_joints() || follows()) return {jog_.now(), kept_.goal()};
  return {joints_.setpoint(phase_ == Phase::JointsMove ? course(moved_s_, duration_s_) : Course{}), kept_.goal()};
}

void FloatingGuidance::tell(bool braked) noexcept {
  parts_.parameters.phase.store(static_cast<std::uint8_t>(braked ? Phase::Braked : phase_));
  kept_.tell();
}

void FloatingGuidance::start(Phase phase, double duration_s) noexcept {
  phase_ = phase;
  duration_s_ = duration_s;
  moved_s_ = settled_s_ = 0;
}

}  // namespace hirosco::robot_arm
