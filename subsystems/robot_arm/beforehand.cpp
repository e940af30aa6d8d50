// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/beforehand.hpp"

#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// No longer: a failure carries 64 octets of words.
constexpr const char* ends_reach = "a singular posture, or it leads out of reach, after mm";
constexpr const char* singular_there = "a singular posture has the tool there";

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
    return {Trouble::line_lost, ends_range_on_line, static_cast<std::int64_t>(*joint + 1)};
  return {Trouble::line_lost, ends_reach, millimetres(line.free_m())};
}

constexpr Reason lasts_too_long{Trouble::too_slow, would_last, static_cast<std::int64_t>(longest_motion_s)};

/// From here on it is on that path; why not: it rests where it is.
[[nodiscard]] std::optional<Reason> plan(Setpoints& setpoints, const JointVector& goal, double speed_share) noexcept {
  if (const Result<> planned = setpoints.go(goal, speed_share); !planned)
    return Reason{Trouble::no_goal, planned.error().text, planned.error().value};
  if (!(setpoints.duration_s() > longest_motion_s)) return std::nullopt;
  setpoints.rest(setpoints.now().position);
  return lasts_too_long;
}

}  // namespace

void Beforehand::begin(double cycle_s) {
  cycle_s_ = cycle_s;
  pose_search_.emplace(parts_.known.model(), parts_.known.tip(), parts_.known.bounds());
  end();
  forget();
}

/// Where it may not stand: nearer to itself, or to what it keeps out of, than it may be and than it is.
std::optional<Reason> Beforehand::forbids(const JointVector& from, const JointVector& posture) noexcept {
  const auto there = parts_.obstacles.nearer(from, posture);
  if (there.distance_m == HUGE_VAL) return std::nullopt;
  return Reason{Trouble::too_near, there.names, millimetres(there.distance_m)};
}

std::optional<Reason> Beforehand::judge_way(Setpoints& setpoints, const JointVector& goal,
                                            double speed_share) noexcept {
  end();
  forget();
  const JointVector here = setpoints.now().position;
  if (auto why = forbids(here, goal)) return why;
  if (auto why = plan(setpoints, goal, speed_share)) return why;
  setpoints.rest(here);  // and goes when that is judged
  way_.begin(here, goal, cycle_s_);
  speed_share_ = speed_share;
  under_way_ = Of::Way;
  return std::nullopt;
}

void Beforehand::search(const robotics::Pose& tip, const JointVector& here, double speed_share,
                        const PreferredPosture& preferred) noexcept {
  forget();
  pose_search_->begin(tip, here, preferred);
  speed_share_ = speed_share;
  under_way_ = Of::Pose;
}

std::optional<Reason> Beforehand::step(Setpoints& setpoints) noexcept {
  switch (under_way_) {
    case Of::Nothing: break;
    case Of::Way: return step_way(setpoints);
    case Of::Pose: return step_search(setpoints);
    case Of::Line: return step_line(setpoints);
  }
  return std::nullopt;
}

/// By what stops it on its way, seen from where it stands: nobody is kept here who would come to his goal.
std::optional<Reason> Beforehand::step_way(Setpoints& setpoints) noexcept {
  if (!way_.step()) {
    end();
    return plan(setpoints, way_.goal(), speed_share_);
  }
  auto why = forbids(way_.from(), way_.posture());
  if (!why) return std::nullopt;
  end();
  blocked_at_ = way_.share();
  return why;
}

/// It stands meanwhile, and has a reason, or the way to the posture is judged from that cycle on in which there is an answer.
std::optional<Reason> Beforehand::step_search(Setpoints& setpoints) noexcept {
  const PoseSearch::Found found = pose_search_->step();
  if (found == PoseSearch::Found::NotYet) return std::nullopt;
  end();
  if (found == PoseSearch::Found::Nothing) return no_posture(*pose_search_);
  if (pose_search_->singular()) return Reason{Trouble::singular, singular_there};
  const JointVector goal = pose_search_->posture();
  return judge_way(setpoints, goal, speed_share_);
}

/// It stands until it was walked along in advance; whoever may not go stands on.
std::optional<Reason> Beforehand::step_line(Setpoints& setpoints) noexcept {
  const Line& line = setpoints.line();
  if (line.found() == Line::Found::NotYet) return std::nullopt;
  end();
  if (line.found() == Line::Found::Nothing) return no_line(line);
  const JointVector here = setpoints.now().position;
  std::optional<Reason> why = forbids(here, line.posture());
  if (!why && line.duration_s() > longest_motion_s) why = lasts_too_long;
  if (why) setpoints.rest(here);
  return why;
}

}  // namespace hirosco::robot_arm
