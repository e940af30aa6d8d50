// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/compliance.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

/// Of the joints while springs are the tool's: what the tool does not feel comes to rest, and where there are more of them than the
/// tool has directions, goes back to its posture by a share of the effort for each rad.
constexpr double posture_damping_per_s = 2;
constexpr double posture_share_per_rad = 0.02;
constexpr Eigen::Index directions = 6;
/// What is felt in a direction that the joints cannot go is not more, kg or kg m2.
constexpr double heaviest = 1e3;

}  // namespace

Compliance::Compliance(const robotics::Model& model, robotics::FrameId tip)
    : model_{&model}, tip_{tip}, still_{model, robotics::Base::Fixed}, goal_{model, robotics::Base::Fixed} {
  impedance_.joint_n_m_rad.setZero(model.joint_count());
  state_.q = state_.qd = carrying_ = impedance_.joint_n_m_rad;
  driven_ = {carrying_, carrying_};
}

void Compliance::weigh(robotics::Dynamics& dynamics, std::span<const double> rotor) noexcept {
  dynamics.mass_matrix(mass_);
  for (Eigen::Index i = 0; i < mass_.rows(); ++i)
    if (static_cast<std::size_t>(i) < rotor.size()) mass_(i, i) += rotor[static_cast<std::size_t>(i)];
}

Jacobian Compliance::tool_jacobian(const robotics::Dynamics& dynamics) const noexcept {
  Jacobian jacobian;
  dynamics.jacobian(tip_, jacobian);
  const Vector3 lever = dynamics.frame_pose(tip_).rotation * tool_m_;
  const robotics::Matrix3 across = robotics::cross_matrix(lever);
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    const Vector3 turning = jacobian.col(i).head<3>();
    jacobian.col(i).tail<3>() -= across * turning;
  }
  return jacobian;
}

/// What is felt in each direction when all others are free.
Vector6 Compliance::tool_inertia(const Jacobian& jacobian) noexcept {
  factors_.compute(mass_);
  Vector6 inertia;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    robotics::Coordinates row = jacobian.row(axis).transpose();
    const robotics::Coordinates moved = factors_.solve(row);
    inertia[axis] = 1 / std::max(row.dot(moved), 1 / heaviest);
  }
  return inertia;
}

/// A spring to the place, and one to the orientation whose potential is k (1 - cos angle): it has no step anywhere.
void Compliance::add_tool(const Setpoint& wanted, const Measured& measured, const robotics::Dynamics& dynamics,
                          double fastest_rad_s, JointVector& torque) noexcept {
  state_.q = wanted.position;
  state_.qd = wanted.velocity;
  goal_.update(state_);
  const robotics::Pose is = dynamics.frame_pose(tip_), goal = goal_.frame_pose(tip_);
  const Jacobian jacobian = tool_jacobian(dynamics);
  const Vector6 inertia = tool_inertia(jacobian);
  Vector6 twist = tool_jacobian(goal_).lazyProduct(wanted.velocity);
  twist -= jacobian.lazyProduct(measured.velocity);
  Vector6 wrench;
  Vector3 turn = Vector3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 one = is.rotation.col(axis), other = goal.rotation.col(axis);
    turn += 0.5 * one.cross(other);
  }
  wrench.head<3>() = impedance_.tool_n_m_rad * turn;
  wrench.tail<3>() = impedance_.tool_n_m * (goal * tool_m_ - is * tool_m_);
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double spring = axis < 3 ? impedance_.tool_n_m_rad : impedance_.tool_n_m;
    wrench[axis] += damper(spring, inertia[axis], impedance_.damping_ratio, fastest_rad_s) * twist[axis];
  }
  torque.noalias() += jacobian.transpose().lazyProduct(wrench);
}

JointVector Compliance::torque(const Setpoint& wanted, const Measured& measured, robotics::Dynamics& dynamics,
                               const Payload& payload, Bounds bounds, const Settings& settings) noexcept {
  state_.q = measured.position;
  state_.qd.setZero(measured.position.size());
  still_.set_gravity(settings.gravity_m_s2);
  still_.update(state_);
  robotics::Coordinates force;
  still_.inverse(wanted.acceleration, force);
  Law::add_payload(payload, tip_, settings.gravity_m_s2, still_, wanted.acceleration, force);
  weigh(dynamics, settings.rotor);
  if (settings.kind == LawKind::Float) float_aims_.remember(measured.position);
  JointVector torque = force;
  const auto joints = model_->joints();
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    const auto& joint = joints[static_cast<std::size_t>(i)];
    const JointBounds& its = bounds[static_cast<std::size_t>(i)];
    const double moved = mass_(i, i), behind = wanted.position[i] - measured.position[i];
    const double slower = wanted.velocity[i] - measured.velocity[i];
    const double rotor =
        static_cast<std::size_t>(i) < settings.rotor.size() ? settings.rotor[static_cast<std::size_t>(i)] : 0;
    torque[i] += rotor * wanted.acceleration[i] + joint.damping * wanted.velocity[i] +
                 joint.friction * std::tanh(wanted.velocity[i] / friction_knee);
    carrying_[i] = torque[i];
    switch (settings.kind) {
      case LawKind::Position: break;
      case LawKind::JointImpedance: {
        const double spring = impedance_.joint_n_m_rad[i];
        torque[i] += spring * behind + damper(spring, moved, impedance_.damping_ratio, settings.fastest_rad_s) * slower;
        break;
      }
      case LawKind::ToolImpedance:
        torque[i] += posture_damping_per_s * moved * slower;
        if (torque.size() > directions) torque[i] += posture_share_per_rad * its.effort * behind;
        break;
      case LawKind::Float:
        torque[i] +=
            std::min(settings.float_damping_per_s * moved, strongest_damper(moved, settings.fastest_rad_s)) * slower;
        break;
      case LawKind::Torque:
        torque[i] += driven_.torque[i] + driven_.brake[i];
        carrying_[i] += driven_.brake[i];
        break;
    }
    const Aim aim = settings.kind == LawKind::Float ? float_aims_.of(i) : Aim{wanted.position[i], wanted.position[i]};
    const double kept_by_walls = walls(aim, wanted.velocity[i], measured, i, moved, its, settings.fastest_rad_s);
    torque[i] += kept_by_walls;
    carrying_[i] += kept_by_walls;
  }
  if (settings.kind == LawKind::ToolImpedance) add_tool(wanted, measured, dynamics, settings.fastest_rad_s, torque);
  return torque;
}

std::optional<std::size_t> Compliance::too_stiff(LawKind kind, const Impedance& impedance, robotics::Dynamics& dynamics,
                                                 std::span<const double> rotor, double rad_s) noexcept {
  weigh(dynamics, rotor);
  const double most = rad_s * rad_s;
  // Written so that what is no number is too stiff.
  if (kind == LawKind::JointImpedance) {
    for (Eigen::Index i = 0; i < mass_.rows(); ++i)
      if (!(impedance.joint_n_m_rad[i] <= most * mass_(i, i))) return static_cast<std::size_t>(i);
  } else if (kind == LawKind::ToolImpedance) {
    const Vector6 inertia = tool_inertia(tool_jacobian(dynamics));
    for (Eigen::Index axis = 0; axis < 6; ++axis)
      if (!((axis < 3 ? impedance.tool_n_m_rad : impedance.tool_n_m) <= most * inertia[axis]))
        return static_cast<std::size_t>(axis);
  }
  return std::nullopt;
}

}  // namespace hirosco::robot_arm
