// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/handling.hpp"

#include <algorithm>
#include <cmath>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_gripper/trouble.hpp"

namespace hirosco::robot_gripper {
namespace {

using End = MotionProgress::End;

/// A telecommand is waited for a little longer.
constexpr double longest_motion_s = 60;
constexpr double back_off_m_s = 0.01;
/// Of all efforts: what may be asked for. Trimming goes a little beyond.
constexpr double most_force_share = 0.8;

[[nodiscard]] std::int64_t micrometres(double metres) noexcept {
  return static_cast<std::int64_t>(std::clamp(1e6 * metres, -1e9, 1e9));
}

}  // namespace

void Handling::take_values(double cycle_s) noexcept {
  const Parameters& values = parts_.parameters;
  cycle_s_ = cycle_s;
  opening_ = {values.acceleration.load(), values.jerk.load(), cycle_s_};
  grip_ = {parts_.fingers,
           {.bandwidth_rad_s = std::min(values.bandwidth_rad_s.load(), robotics::fastest_rad_s(cycle_s_)),
            .width_force_n = std::min(values.move_force_n.load(), parts_.fingers.most_force_n()),
            .acceleration_m_s2 = values.acceleration.load(),
            .cycle_s = cycle_s_}};
  grip_.set_tolerance(values.force_tolerance.load());
}

// --- where actuators begin and end ---------------------------------------------------------------------------------------

void Handling::engage() noexcept {
  opening_.rest(gap().width_m);
  if (held_.held()) grip_.press_on(held_force_n_, grip_speed_m_s_);
  else grip_.keep();
}

void Handling::keep(double width_m) noexcept {
  opening_.rest(width_m);
  grip_.keep();
}

void Handling::stand() noexcept {
  if (grip_.law() == Law::Press) return;
  if (grip_.law() == Law::Width) {
    opening_.brake();
    return;
  }
  opening_.brake_from(gap().width_m, gap().speed_m_s);
  grip_.keep();
}

bool Handling::recognise() noexcept {
  if (held_.held() || !(gap().force_n >= parts_.parameters.felt_force_n.load()) ||
      !(gap().width_m > parts_.parameters.empty_width_m.load()))
    return false;
  held_.hold(gap().width_m);
  held_force_n_ = std::min(gap().force_n, most_force_n());
  return true;
}

// --- functions -----------------------------------------------------------------------------------------------------------

double Handling::most_force_n() const noexcept { return most_force_share * parts_.fingers.most_force_n(); }

Outcome Handling::move_to(double width_m, double speed_m_s) noexcept {
  const Fingers& fingers = parts_.fingers;
  if (!(width_m >= 0 && width_m <= fingers.full_width_m()))
    return refused(Trouble::out_of_range, "micrometres at most", micrometres(fingers.full_width_m()));
  if (!(speed_m_s <= fingers.most_speed_m_s()))
    return refused(Trouble::out_of_range, "micrometres a second at most", micrometres(fingers.most_speed_m_s()));
  if (held_.held() && width_m <= gap().width_m) return refused(Trouble::is_held, "GRIP with another force, or open");
  if (std::abs(width_m - gap().width_m) > longest_motion_s * speed_m_s)
    return refused(Trouble::too_slow, "it would take longer, s", static_cast<std::int64_t>(longest_motion_s));
  if (grip_.law() != Law::Width) {
    opening_.rest(gap().width_m);
    grip_.let_go();
  }
  if (const auto planned = opening_.go(width_m, speed_m_s); !planned)
    return refused(Trouble::no_goal, planned.error().text, planned.error().value);
  held_.let_go();
  progress_.begin_path(width_m, cycle_s_);
  return running;
}

Outcome Handling::grip(double force_n, double speed_m_s) noexcept {
  const Fingers& fingers = parts_.fingers;
  if (!(force_n <= most_force_n()))
    return refused(Trouble::out_of_range, "millinewtons at most", static_cast<std::int64_t>(1e3 * most_force_n()));
  if (!(speed_m_s <= fingers.most_speed_m_s()))
    return refused(Trouble::out_of_range, "micrometres a second at most", micrometres(fingers.most_speed_m_s()));
  if (!held_.held() && gap().width_m > longest_motion_s * speed_m_s)
    return refused(Trouble::too_slow, "it would take longer, s", static_cast<std::int64_t>(longest_motion_s));
  opening_.rest(gap().width_m);
  grip_.grip(force_n, speed_m_s);
  grip_speed_m_s_ = speed_m_s;
  held_force_n_ = force_n;
  progress_.begin_grip(cycle_s_);
  return running;
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

Held::Change Handling::watch_held() noexcept {
  const Held::Change change = held_.update(gap().width_m, parts_.parameters.lost_distance_m.load());
  if (change == Held::Change::LostClosed) {
    opening_.brake_from(gap().width_m, gap().speed_m_s);
    grip_.keep();
  }
  return change;
}

MotionProgress::News Handling::advance(bool awaited) noexcept {
  opening_.advance();
  if (grip_.law() != Law::Width) return follow_grip(awaited);
  return awaited ? follow_path() : MotionProgress::News{};
}

MotionProgress::News Handling::follow_path() noexcept {
  const MotionProgress::News news = progress_.follow(opening_, gap().width_m,
                                                     {.behind_m = parts_.parameters.following_limit_m.load(),
                                                      .off_goal_m = parts_.parameters.width_tolerance_m.load()});
  if (news.end == End::Obstructed) back_off();
  if (news.end == End::NotReached) opening_.rest(gap().width_m);
  return news;
}

/// Keeping the width where something is in the way would go on pressing on it.
void Handling::back_off() noexcept {
  const double limit_m = parts_.parameters.following_limit_m.load();
  const double back_m = progress_.goal_m() < gap().width_m ? limit_m : -limit_m;
  keep(gap().width_m);
  // Planned between two numbers within the range: it has a way.
  static_cast<void>(opening_.go(std::clamp(gap().width_m + back_m, 0.0, parts_.fingers.full_width_m()), back_off_m_s));
}

/// Who presses with less than it is to goes on, whoever gives up waiting: there may be something.
MotionProgress::News Handling::follow_grip(bool awaited) noexcept {
  const End met = MotionProgress::met(grip_, gap().width_m, parts_.parameters.empty_width_m.load());
  MotionProgress::News news;
  if (awaited) news = progress_.follow(grip_, met);
  else if (!held_.held()) news.end = met;
  if (news.end == End::NothingMet) {
    keep(gap().width_m);
  } else if (news.end == End::Held) {
    held_.hold(gap().width_m);
    held_force_n_ = grip_.wanted_force_n();
  } else if (!awaited && !held_.held()) {
    stand();  // nobody is waiting for it to meet something
  }
  return news;
}

void Handling::control() noexcept {
  parts_.drives.put_out(grip_.torques(opening_.now(), parts_.drives.measured()));
  tell();
}

void Handling::tell() noexcept {
  parts_.parameters.gap.store({gap().width_m, gap().speed_m_s, gap().force_n,
                               static_cast<std::uint8_t>(held_.held() ? 1 : 0), static_cast<std::uint8_t>(grip_.law()),
                               grip_.law() == Law::Width ? opening_.now().width_m : held_.width_m(),
                               grip_.wanted_force_n(), held_.width_m()});
}

}  // namespace hirosco::robot_gripper
