// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/guidance.hpp"

#include <span>

namespace hirosco::robot_arm {
namespace {

/// Of a line, before it is given up.
constexpr double most_off_line_m = 0.002;
/// A way back from a contact takes 10 s at most, and whoever brakes is there sooner.
constexpr double longest_wait_s = 12;
/// With which MOVE_ABORT goes unless it is told another one: who says that a path is free says it of this.
constexpr double usual_share = 0.25;

[[nodiscard]] bool in_range(Bounds bounds, const JointVector& goal) noexcept {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double value = goal[static_cast<Eigen::Index>(i)];
    if (!(value >= bounds[i].lowest && value <= bounds[i].highest)) return false;
  }
  return true;
}

[[nodiscard]] Result<robotics::Pose> wanted_pose(const FunctionValues& values) noexcept {
  const robotics::Quaternion wanted{values[3], values[4], values[5], values[6]};
  if (!(wanted.norm() > 0.5 && wanted.norm() < 1.5)) return fail(ErrorCode::InvalidArgument, "no orientation");
  return robotics::Pose{wanted.normalized().toRotationMatrix(), {values[0], values[1], values[2]}};
}

[[nodiscard]] Outcome refused_for(const Reason& why) noexcept { return refused(why.trouble, why.text, why.number); }

[[nodiscard]] Reason reason_of(const NoWayOut& none) noexcept {
  using Why = NoWayOut::Why;
  const Trouble trouble = none.why == Why::OutOfRange ? Trouble::out_of_range
                          : none.why == Why::TooNear  ? Trouble::too_near
                          : none.why == Why::TooSlow  ? Trouble::too_slow
                                                      : Trouble::no_goal;
  return {trouble, none.text, none.number};
}

/// What is in the way can be seen from here alone: where it would be, a line needs another posture.
[[nodiscard]] Reason line_left(const Setpoints& setpoints) noexcept {
  if (const auto joint = setpoints.joint_in_the_way())
    return {Trouble::line_lost, ends_range_on_line, static_cast<std::int64_t>(*joint + 1)};
  return {Trouble::line_lost, "on the line is a singular posture, after mm", millimetres(setpoints.gone_m())};
}

}  // namespace

void Guidance::begin(double cycle_s) {
  cycle_s_ = cycle_s;
  setpoints_.emplace(parts_.known.model(), parts_.known.tip(), parts_.known.bounds(), cycle_s_);
  before_.begin(cycle_s_);
  parts_.abort_path.begin_cycles(cycle_s_);
  retracting_ = false;
  end_motion();
}

void Guidance::engage() noexcept {
  setpoints_->begin(parts_.drives.measured().position);
  retracting_ = false;
}

void Guidance::retract() noexcept {
  const Measured& measured = parts_.drives.measured();
  setpoints_->retract(measured.position, measured.velocity, parts_.parameters.retract_distance.load());
  retracting_ = true;
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

void Guidance::advance(bool led) noexcept {
  if (jog_left_s_ > 0 && (jog_left_s_ -= cycle_s_) <= 0) setpoints_->brake();
  if (led) setpoints_->begin(parts_.drives.measured().position);
  static_cast<void>(setpoints_->advance());
  if (!at_rest()) before_.forget();
}

std::optional<double> Guidance::end_retract() noexcept {
  if (!retracting_ || !setpoints_->at_rest()) return std::nullopt;
  retracting_ = false;
  return setpoints_->retracted_by();
}

void Guidance::tell() noexcept {
  const double duration_s = abort_.goes() ? abort_.duration_s() : setpoints_->duration_s();
  parts_.parameters.motion.store({static_cast<std::uint8_t>(setpoints_->kind()), duration_s, progress()});
}

/// Of an abort path the whole, and not the way to a posture of it; of who was not let go, where somebody is in his way.
double Guidance::progress() const noexcept {
  if (before_.blocked_at()) return *before_.blocked_at();
  return abort_.goes() ? abort_.progress(*setpoints_) : setpoints_->progress();
}

Guidance::News Guidance::look(bool gives_way) noexcept {
  if (waiting_) return wait();
  if (abort_.under_way()) return look_at_abort(gives_way);
  if (setpoints_->off_line_m() > most_off_line_m) return lose_line();
  if (before_.under_way()) {
    const std::optional<Reason> why = before_.step(*setpoints_);
    return why ? News{.end = End::NoWay, .why = *why} : News{};
  }
  News news;
  news.half_way = arrival_.tell_half(progress() >= 0.5);
  if (setpoints_->at_rest())
    news.end = arrival_.goes_back() && !setpoints_->retreated() ? End::NotReached : arrive(gives_way);
  return news;
}

Guidance::News Guidance::lose_line() noexcept {
  const Reason why = line_left(*setpoints_);
  setpoints_->brake();
  return {.end = End::LineLost, .why = why};
}

/// Who gives way is wherever he was pushed.
Guidance::End Guidance::arrive(bool gives_way) noexcept {
  const double tolerance = parts_.parameters.goal_tolerance.load();
  const JointVector left = setpoints_->now().position - parts_.drives.measured().position;
  if (!arrival_.path_ended()) arrival_.end_path(setpoints_->tool());
  const robotics::Pose tool = pose_of(parts_.parameters.tool.load());
  arrival_.wait(gives_way || arrival_.there(left, tolerance, tool), cycle_s_);
  if (arrival_.settled()) return End::Reached;
  return arrival_.overdue() ? End::NotReached : End::None;
}

// --- functions -----------------------------------------------------------------------------------------------------------

Outcome Guidance::start(const Result<>& planned) noexcept {
  if (!planned) return refused(Trouble::no_goal, planned.error().text, planned.error().value);
  if (setpoints_->duration_s() > longest_motion_s) {
    setpoints_->rest(setpoints_->now().position);
    return refused(Trouble::too_slow, would_last, static_cast<std::int64_t>(longest_motion_s));
  }
  arrival_.begin(Arrival::To::Goal);
  end_motion();
  return running;
}

void Guidance::lead() noexcept {
  end_motion();
  arrival_.begin(Arrival::To::Nowhere);
}

Outcome Guidance::start_jog(Begin by, double seconds) noexcept {
  arrival_.begin(Arrival::To::Nowhere);
  jog_left_s_ = seconds;
  jog_ = by;
  return running;
}

Outcome Guidance::move_j(const FunctionValues& values) noexcept {
  const std::size_t joints = parts_.known.joints();
  const JointVector goal = vector_of(std::span{values}.first(joints));
  if (!in_range(parts_.known.bounds(), goal)) return refused(Trouble::out_of_range);
  end_motion();
  if (const auto why = before_.judge_way(*setpoints_, goal, values[joints])) return refused_for(*why);
  arrival_.begin(Arrival::To::Goal);
  return running;
}

Outcome Guidance::move_p(const FunctionValues& values) noexcept {
  const Result<robotics::Pose> goal = wanted_pose(values);
  if (!goal) return refused(Trouble::no_goal, goal.error().text);
  const PreferredPosture preferred = parts_.posture.preferred();
  if (const auto why = parts_.posture.unfit(preferred)) return refused_for(*why);
  end_motion();
  before_.search(setpoints_->tip_with(*goal), setpoints_->now().position, values[7], preferred);
  arrival_.begin(Arrival::To::Goal);
  arrival_.expect_tool(goal->position);
  return running;
}

Outcome Guidance::move_l(const FunctionValues& values) noexcept {
  const Result<robotics::Pose> goal = wanted_pose(values);
  if (!goal) return refused(Trouble::no_goal, goal.error().text);
  const PreferredPosture preferred = parts_.posture.preferred();
  if (const auto why = parts_.posture.unfit(preferred)) return refused_for(*why);
  const Outcome started = start(setpoints_->go_straight(*goal, {values[7], values[8]}, preferred));
  if (started.kind == Outcome::Kind::Refused) return started;
  arrival_.expect_tool(goal->position);
  before_.judge_line();
  return started;
}

Outcome Guidance::retreat(const FunctionValues& values) noexcept {
  const JointVector here = setpoints_->now().position;
  setpoints_->retract(here, JointVector::Zero(here.size()), values[0]);
  if (setpoints_->kind() != Setpoints::Kind::Retract) {
    setpoints_->rest(here);
    return refused(Trouble::no_goal, "it came here by no way since it entered Operational");
  }
  end_motion();
  arrival_.begin(Arrival::To::WayBack);
  retracting_ = true;
  return running;
}

// --- out, once it stands -------------------------------------------------------------------------------------------------

/// Whatever takes the actuators away, stops the arm or lets it float meanwhile ends this as it ends a motion.
Outcome Guidance::once_it_stands(Begin way_out, const FunctionValues& values) noexcept {
  end_motion();
  waiting_ = Waiting{way_out, values, longest_wait_s};
  return running;
}

Guidance::News Guidance::wait() noexcept {
  waiting_->left_s -= cycle_s_;
  if (!setpoints_->at_rest()) return {.end = waiting_->left_s > 0 ? End::None : End::NotReached};
  const Waiting waited = *waiting_;
  waiting_.reset();
  const Outcome begun = (this->*waited.begin)(waited.values);
  if (begun.kind != Outcome::Kind::Refused) return {.begun = true};
  return {.end = End::NoWay, .why = {static_cast<Trouble>(begun.code), begun.reason.text, begun.reason.value}};
}

// --- the abort path ------------------------------------------------------------------------------------------------------

Outcome Guidance::move_abort(const FunctionValues& values) noexcept {
  return judge_abort(AbortWay::Judged::FromHere, values[0]);
}

Outcome Guidance::check_abort() noexcept { return judge_abort(AbortWay::Judged::PathAlone, usual_share); }

Outcome Guidance::judge_abort(AbortWay::Judged what, double speed_share) noexcept {
  if (const auto none = parts_.abort_path.begin(setpoints_->now().position, what)) return refused_for(reason_of(*none));
  end_motion();
  arrival_.begin(Arrival::To::Goal);
  abort_.begin(what, speed_share);
  return running;
}

Guidance::News Guidance::look_at_abort(bool gives_way) noexcept {
  using At = AbortMotion::At;
  const bool went = abort_.goes();
  const At at = abort_.step(*setpoints_);
  News news;
  // With more power than it began with the whole way may be less than half of what was foreseen.
  news.half_way = arrival_.tell_half(went && (progress() >= 0.5 || at == At::Last));
  switch (at) {
    case At::OnWay: break;
    case At::Judged: news.end = End::Judged; break;
    case At::Last: news.end = arrive(gives_way); break;
    case At::Lost: news.end = End::NotReached; break;
    case At::NoWay: news.end = End::NoWay, news.why = reason_of(abort_.why()); break;
  }
  return news;
}

Outcome Guidance::jog_j(const FunctionValues& values) noexcept {
  const std::size_t joints = parts_.known.joints();
  setpoints_->jog(vector_of(std::span{values}.first(joints)));
  return start_jog(&Guidance::jog_j, values[joints]);
}

Outcome Guidance::jog_l(const FunctionValues& values) noexcept {
  Vector6 twist;
  twist << values[3], values[4], values[5], values[0], values[1], values[2];
  setpoints_->jog(twist);
  return start_jog(&Guidance::jog_l, values[6]);
}

}  // namespace hirosco::robot_arm
