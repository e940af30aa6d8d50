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
constexpr const char* ends_range = "on the line ends the range of joint";
/// No longer: a failure carries 64 octets of words.
constexpr const char* ends_reach = "a singular posture, or it leads out of reach, after mm";
constexpr const char* singular_there = "a singular posture has the tool there";

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

/// Of a search that has found nothing.
[[nodiscard]] Reason no_posture(PoseSearch& search) noexcept {
  if (const auto joint = search.joint_at_its_end())
    return {Trouble::out_of_range, "before it is there ends the range of joint", static_cast<std::int64_t>(*joint + 1)};
  if (search.nearly() && search.singular()) return {Trouble::singular, singular_there};
  return {Trouble::out_of_reach, "as near as it comes, mm", millimetres(search.off_m())};
}

/// Of a line that was walked along in advance, and ends before its end.
[[nodiscard]] Reason no_line(const Line& line) noexcept {
  if (const auto joint = line.joint_in_the_way())
    return {Trouble::line_lost, ends_range, static_cast<std::int64_t>(*joint + 1)};
  return {Trouble::line_lost, ends_reach, millimetres(line.free_m())};
}

/// What is in the way can be seen from here alone: where it would be, a line needs another posture.
[[nodiscard]] Reason line_left(const Setpoints& setpoints) noexcept {
  if (const auto joint = setpoints.joint_in_the_way())
    return {Trouble::line_lost, ends_range, static_cast<std::int64_t>(*joint + 1)};
  return {Trouble::line_lost, "on the line is a singular posture, after mm", millimetres(setpoints.gone_m())};
}

}  // namespace

void Guidance::begin(double cycle_s) {
  cycle_s_ = cycle_s;
  setpoints_.emplace(parts_.known.model(), parts_.known.tip(), parts_.known.bounds(), cycle_s_);
  pose_search_.emplace(parts_.known.model(), parts_.known.tip(), parts_.known.bounds());
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

/// Of an abort path the whole, and not the way to a posture of it.
double Guidance::progress() const noexcept {
  return abort_.goes() ? abort_.progress(*setpoints_) : setpoints_->progress();
}

Guidance::News Guidance::look(bool gives_way) noexcept {
  if (waiting_) return wait();
  if (abort_.under_way()) return look_at_abort(gives_way);
  if (setpoints_->off_line_m() > most_off_line_m) return lose_line();
  if (searched_ || !line_judged_) {
    const std::optional<Reason> why = searched_ ? search() : judge_line();
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

/// Where it may not stand: nearer to itself, or to what it keeps out of, than it may be and than it is.
std::optional<Reason> Guidance::forbids(const JointVector& goal) noexcept {
  const auto there = parts_.obstacles.nearer(setpoints_->now().position, goal);
  if (there.distance_m == HUGE_VAL) return std::nullopt;
  return Reason{Trouble::too_near, there.names, millimetres(there.distance_m)};
}

Outcome Guidance::move_j(const FunctionValues& values) noexcept {
  const std::size_t joints = parts_.known.joints();
  const JointVector goal = vector_of(std::span{values}.first(joints));
  if (!in_range(parts_.known.bounds(), goal)) return refused(Trouble::out_of_range);
  if (const auto why = forbids(goal)) return refused(why->trouble, why->text, why->number);
  return start(setpoints_->go(goal, values[joints]));
}

Outcome Guidance::move_p(const FunctionValues& values) noexcept {
  const Result<robotics::Pose> goal = wanted_pose(values);
  if (!goal) return refused(Trouble::no_goal, goal.error().text);
  pose_search_->begin(setpoints_->tip_with(*goal), setpoints_->now().position);
  end_motion();
  arrival_.begin(Arrival::To::Goal);
  searched_ = Searched{goal->position, values[7]};
  return running;
}

/// It stands meanwhile, and has a reason, or goes, in that cycle in which there is an answer.
std::optional<Reason> Guidance::search() noexcept {
  const PoseSearch::Found found = pose_search_->step();
  if (found == PoseSearch::Found::NotYet) return std::nullopt;
  const Searched wanted = *searched_;
  searched_.reset();
  if (found == PoseSearch::Found::Nothing) return no_posture(*pose_search_);
  const JointVector& goal = pose_search_->posture();
  if (pose_search_->singular()) return Reason{Trouble::singular, singular_there};
  if (auto why = forbids(goal)) return why;
  const Outcome started = start(setpoints_->go(goal, wanted.speed_share));
  if (started.kind == Outcome::Kind::Refused)
    return Reason{static_cast<Trouble>(started.code), started.reason.text, started.reason.value};
  arrival_.expect_tool(wanted.tool_m);
  return std::nullopt;
}

Outcome Guidance::move_l(const FunctionValues& values) noexcept {
  const Result<robotics::Pose> goal = wanted_pose(values);
  if (!goal) return refused(Trouble::no_goal, goal.error().text);
  const Outcome started = start(setpoints_->go_straight(*goal, {values[7], values[8]}));
  if (started.kind == Outcome::Kind::Refused) return started;
  arrival_.expect_tool(goal->position);
  line_judged_ = false;
  return started;
}

/// It stands until it was walked along in advance; whoever may not go stands on.
std::optional<Reason> Guidance::judge_line() noexcept {
  const Line& line = setpoints_->line();
  if (line.found() == Line::Found::NotYet) return std::nullopt;
  line_judged_ = true;
  if (line.found() == Line::Found::Nothing) return no_line(line);
  std::optional<Reason> why = forbids(line.posture());
  if (!why && line.duration_s() > longest_motion_s)
    why = Reason{Trouble::too_slow, would_last, static_cast<std::int64_t>(longest_motion_s)};
  if (why) setpoints_->rest(setpoints_->now().position);
  return why;
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
  const Outcome stored = parts_.abort_path.begin(setpoints_->now().position, what);
  if (stored.kind == Outcome::Kind::Refused) return stored;
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
    case At::NoWay: news.end = End::NoWay, news.why = abort_.why(); break;
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
