// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/self_check.hpp"

#include <array>
#include <cmath>

namespace hirosco::manipulator {
namespace {

constexpr double displacement_rad = 0.01;
constexpr double velocity_rad_s = 0.05;
constexpr double load_n_m = 0.5;
/// Each of these asks for more than that of a law within the declared gains.
constexpr double least_answer_n_m = 0.5;
/// Of the other joints: the law is one for each joint.
constexpr double most_crosstalk_n_m = 0.01;

constexpr double rest_rad_s = 0.05;
constexpr double most_windup_rad = 0.1;  ///< between motor and joint
constexpr double past_stop_rad = 0.05;

[[nodiscard]] std::unexpected<Error> fails(const char* what, std::size_t joint) noexcept {
  return fail(ErrorCode::Internal, what, static_cast<std::int64_t>(joint + 1));
}

}  // namespace

Result<Step> SelfCheck::step(const Cycle& cycle) noexcept {
  if (cycle.first) {
    tried_ = 0;
    HIROSCO_TRY(check_sensors());
  }
  const double side = tried_ % 2 == 0 ? 1.0 : -1.0;
  const auto checked = check_law(tried_ / 2, side);
  // The node of the next cycle begins where the joints are, as ever.
  parts_.setpoint.rest();
  if (!checked) return std::unexpected{checked.error()};
  return ++tried_ < 2 * parts_.joints.count() ? again : done;
}

Result<> SelfCheck::check_sensors() const noexcept {
  const DescribedJoints& joints = parts_.joints;
  if (!parts_.drives.alive()) return fail(ErrorCode::Unavailable, "the robot says nothing");
  const Measured now = parts_.drives.measured();
  for (std::size_t i = 0; i < joints.count(); ++i) {
    // Written so that what is no number fails.
    if (!(std::abs(now.velocity_rad_s[i]) < rest_rad_s && std::abs(now.motor_velocity_rad_s[i]) < rest_rad_s))
      return fails("it moves though nothing drives it, joint", i);
    if (!(now.position_rad[i] > joints.lowest_rad()[i] - past_stop_rad &&
          now.position_rad[i] < joints.highest_rad()[i] + past_stop_rad))
      return fails("measured outside of its range, joint", i);
    if (!(std::abs(now.position_rad[i] - now.motor_position_rad[i]) < most_windup_rad))
      return fails("motor and joint are measured apart, joint", i);
    if (!(std::abs(now.torque_n_m[i]) < parts_.parameters.torque_limit.load()))
      return fails("its load at rest is above its limit, joint", i);
  }
  if (parts_.watch.too_hot()) return fail(ErrorCode::Unavailable, "too hot");
  return ok();
}

Result<> SelfCheck::check_law(std::size_t joint, double side) noexcept {
  const Measured now = parts_.drives.measured();
  const Joints& here = now.motor_position_rad;
  const Joints at_rest = parts_.servo.wish(here, now);
  struct Deviation {
    Joints desired_rad;
    Measured measured;
    double answer;  ///< its direction
    const char* wrong;
  };
  std::array<Deviation, 3> deviations{Deviation{here, now, side, "driven away from its setpoint, joint"},
                                      Deviation{here, now, -side, "driven on in its motion, joint"},
                                      Deviation{here, now, -side, "driven with its load, joint"}};
  deviations[0].desired_rad[joint] += side * displacement_rad;
  deviations[1].measured.motor_velocity_rad_s[joint] += side * velocity_rad_s;
  deviations[2].measured.torque_n_m[joint] += side * load_n_m;
  for (const Deviation& deviation : deviations) {
    const Joints wanted = parts_.servo.wish(deviation.desired_rad, deviation.measured);
    for (std::size_t i = 0; i < parts_.joints.count(); ++i) {
      const double answer = wanted[i] - at_rest[i];
      if (i == joint && !(deviation.answer * answer > least_answer_n_m)) return fails(deviation.wrong, joint);
      if (i != joint && !(std::abs(answer) < most_crosstalk_n_m)) return fails("driven by another joint, joint", i);
    }
  }
  return ok();
}

}  // namespace hirosco::manipulator
