// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/tool_law.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "subsystems/robot_arm/floating/range_ends.hpp"

namespace hirosco::robot_arm {
namespace {

constexpr double error_per_s = 1;  ///< of the tool
/// Of a joint's velocity, for where a tool leaves it free to go: the rest is the tool's.
constexpr double drawn_share = 0.25;
constexpr double attitude_per_s = 0.5;  ///< of the base
/// Damping of least squares: of a matrix without base rates, and with them, whose rows are small.
constexpr double tool_damping = 1e-3, base_damping = 1e-4;

/// Who goes towards an end of its range counts for less, and then others do it; each time fewer joints are left. Far from all ends the weights
/// are 1, and what comes out is what comes out without them, bit by bit.
[[nodiscard]] JointVector least_squares(const FloatingModel::Twists& rows, const Vector6& wanted, double damping,
                                        const JointVector& position, Bounds bounds, const JointVector* drawn) noexcept {
  JointVector weight = JointVector::Ones(rows.cols()), rates;
  for (Eigen::Index pass = 0; pass <= rows.cols(); ++pass) {
    FloatingModel::Twists weighted = rows;
    for (Eigen::Index joint = 0; joint < rows.cols(); ++joint) weighted.col(joint) *= weight[joint];
    robotics::Matrix6 square;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) square(i, j) = weighted.row(i).dot(rows.row(j)) + (i == j ? damping * damping : 0);
    Vector6 left = wanted;
    JointVector besides;
    if (drawn != nullptr) {
      besides = weight.cwiseProduct(*drawn);
      left.noalias() -= rows.lazyProduct(besides);
    }
    const Vector6 along = Eigen::LDLT<robotics::Matrix6>{square}.solve(left);
    rates = JointVector::Zero(rows.cols());
    for (int i = 0; i < 6; ++i) rates += along[i] * weighted.row(i).transpose();
    if (drawn != nullptr) rates += besides;
    bool more = false;
    for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
      const auto i = static_cast<Eigen::Index>(joint);
      const double least = weight_near_end(bounds[joint], position[i], rates[i]);
      if (!(least < weight[i])) continue;
      weight[i] = least;
      more = true;
    }
    if (!more) break;
  }
  return rates;
}

}  // namespace

Vector3 rotation_between(const robotics::Matrix3& is, const robotics::Matrix3& wanted) noexcept {
  robotics::Quaternion off{robotics::Matrix3{wanted * is.transpose()}};
  if (off.w() < 0) off.coeffs() = -off.coeffs();
  const double sine = off.vec().norm();
  if (sine < 1e-12) return 2 * off.vec();
  return 2 * std::atan2(sine, off.w()) / sine * off.vec();
}

JointVector tool_rates(ToolLaw law, const FloatingModel& model, Bounds bounds, const ToolGoal& goal,
                       const robotics::Matrix3& base, const robotics::Matrix3& base_kept,
                       const JointVector* drawn) noexcept {
  Vector6 wanted;
  wanted.tail<3>() = goal.velocity_m_s + error_per_s * (goal.pose.position - model.tool().position);
  wanted.head<3>() = goal.turning_rad_s + error_per_s * rotation_between(model.tool().rotation, goal.pose.rotation);
  if (law != ToolLaw::AttitudeHold)
    return least_squares(law == ToolLaw::FixedBase ? model.tool_of_fixed() : model.tool_of_free(), wanted, tool_damping,
                         model.position(), bounds, drawn);
  FloatingModel::Twists both = model.tool_of_free();
  both.topRows<3>() = model.base().topRows<3>();
  wanted.head<3>() = attitude_per_s * (base.transpose() * rotation_between(base, base_kept));
  return least_squares(both, wanted, base_damping, model.position(), bounds, drawn);
}

JointVector drawn_to(const PreferredPosture& preferred, const JointVector& position, Bounds bounds,
                     double share) noexcept {
  JointVector drawn = share * preferred.gain_per_s * (preferred.joints - position);
  double within = 1;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double rate = std::abs(drawn[static_cast<Eigen::Index>(i)]), most = drawn_share * bounds[i].motion.velocity;
    if (rate > most) within = std::min(within, most / rate);
  }
  return within * drawn;
}

void slow_down(JointVector& rates, Bounds bounds) noexcept {
  double share = 1;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double rate = std::abs(rates[static_cast<Eigen::Index>(i)]);
    if (rate > bounds[i].motion.velocity) share = std::min(share, bounds[i].motion.velocity / rate);
  }
  if (rates.allFinite()) rates *= share;
  else rates.setZero();
}

double followed_with(double heavier, double cycle_s) noexcept {
  constexpr double half_of_stable = 0.32;  // of what followed_per_s is a quarter of with 4 ms
  return std::min(followed_per_s, half_of_stable / (cycle_s * heavier));
}

JointVector joint_torque(const FloatingModel& model, const JointVector& wanted_rates, const JointVector& rates,
                         Bounds bounds, double per_s) noexcept {
  const JointVector off = per_s * (wanted_rates - rates);
  JointVector torque = JointVector::Zero(off.size());
  for (Eigen::Index i = 0; i < off.size(); ++i) {
    const double value = model.inertia().row(i).dot(off);
    const double effort = bounds[static_cast<std::size_t>(i)].effort;
    torque[i] = std::isfinite(value) ? std::clamp(value, -effort, effort) : 0;
  }
  return torque;
}

Course course(double t_s, double duration_s) noexcept {
  if (!(t_s < duration_s)) return {};
  const double x = std::max(0.0, t_s / duration_s);
  return {x * x * x * (10 + x * (6 * x - 15)), 30 * x * x * (1 - x) * (1 - x) / duration_s};
}

}  // namespace hirosco::robot_arm
