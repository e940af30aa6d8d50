// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hirosco/utilities/result.hpp"
#include "robotics/dynamics/model.hpp"
#include "robotics/dynamics/spatial.hpp"

namespace hirosco::robotics {

/// These have room for the largest robot in themselves: none of them ever uses the heap.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_joints, 1>;
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_coordinates, 1>;
using MassMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_coordinates, max_coordinates>;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, max_coordinates>;

enum class Base : std::uint8_t {
  Fixed,                             ///< held where it is
  Free,                              ///< floats: six coordinates before those of the joints
};

/// Where a robot is and how it moves.
struct State {
  Vector3 base_position{Vector3::Zero()};                  ///< of the base's origin, inertial
  Quaternion base_orientation{Quaternion::Identity()};     ///< inertial from base, of length 1
  Vector6 base_twist{Vector6::Zero()};  ///< [ω; v] of the base's origin in its own axes; not looked at when fixed
  JointVector q;  ///< rad or m
  JointVector qd;
};

struct Momentum {
  Vector3 linear;  ///< kg m/s, inertial axes
  Vector3 angular;  ///< kg m2/s, inertial axes, about the centre of mass of all
};

class Dynamics;

/// Accelerations by the mass matrix, of a robot whose joints mimic others.
class ByMassMatrix {
 public:
  explicit ByMassMatrix(int coordinates) : factors_{coordinates} {}
  /// As Dynamics::forward(), in its state.
  [[nodiscard]] Result<> forward(Dynamics& dynamics, const Coordinates& force, Coordinates& acceleration) noexcept;

 private:
  MassMatrix matrix_;
  Coordinates bias_;
  Eigen::LLT<MassMatrix> factors_;
};

/// The equations of motion of one robot and all that follows from them. update() takes a state, everything else is of that
/// state. Vectors of coordinates, velocities and forces have, for a free base, first the base's [ω; v] and [n; f] (own axes, at its
/// origin), then the joints; for a fixed one the joints alone. Accelerations of the base are the derivatives of the numbers of its twist.
///
/// How: everything is expressed in the axes of the base at its origin, so that inertias, momenta and forces of bodies simply add up
/// and no figure depends on how far away the inertial origin is.
/// Realtime: construction allocates, nothing else does: wait-free, time grows with the number of bodies, mass_matrix() with its square.
/// Thread: one at a time; a copy is independent.
class Dynamics {
 public:
  /// `model` must outlive this.
  Dynamics(const Model& model, Base base);

  /// In inertial axes, m/s2; at first there is none.
  void set_gravity(const Vector3& gravity_m_s2) noexcept { gravity_ = gravity_m_s2; }
  /// Numbers of joints are the model's; `base_orientation` is of length 1.
  void update(const State& state) noexcept;

  [[nodiscard]] const Model& model() const noexcept { return *model_; }
  [[nodiscard]] Base base() const noexcept { return base_; }
  /// Of velocities and forces: joints, and six of a free base.
  [[nodiscard]] int coordinate_count() const noexcept { return first_joint_ + model_->joint_count(); }

  /// What accelerations these forces make (articulated body algorithm; by the mass matrix where joints mimic others).
  /// OutOfRange: something that moves has no inertia against it. `acceleration` is then worth nothing.
  [[nodiscard]] Result<> forward(const Coordinates& force, Coordinates& acceleration) noexcept;
  /// What forces these accelerations take (recursive Newton-Euler), gravity included.
  void inverse(const Coordinates& acceleration, Coordinates& force) noexcept;
  /// The forces that keep all accelerations 0: of gravity and of velocity.
  void bias(Coordinates& force) noexcept;
  /// Composite rigid bodies. Symmetric, both halves filled.
  void mass_matrix(MassMatrix& matrix) noexcept;

  [[nodiscard]] Pose frame_pose(FrameId frame) const noexcept;  ///< inertial
  [[nodiscard]] Vector6 frame_twist(FrameId frame) const noexcept;  ///< [ω; v] of its origin, inertial axes
  /// From velocities to frame_twist().
  void jacobian(FrameId frame, Jacobian& jacobian) const noexcept;
  /// What of the acceleration of frame_twist() comes from velocities alone: the derivative of the Jacobian times the velocities.
  [[nodiscard]] Vector6 frame_drift(FrameId frame) const noexcept;
  /// From joint velocities to the twist of a frame of a free robot that has no momentum (generalised Jacobian); of a fixed one
  /// its Jacobian. OutOfRange: the robot as a whole has no inertia against a rotation.
  [[nodiscard]] Result<> generalised_jacobian(FrameId frame, Jacobian& jacobian) noexcept;

  [[nodiscard]] Vector3 centre_of_mass() const noexcept;  ///< of all bodies with the base, inertial
  [[nodiscard]] Momentum momentum() const noexcept;
  [[nodiscard]] double kinetic_energy() const noexcept;  ///< J
  [[nodiscard]] double potential_energy() const noexcept;  ///< J, 0 with the centre of mass at the inertial origin

 private:
  /// Of one body, in the base's axes at its origin.
  struct Moving {
    Pose pose;  ///< of its frame
    Vector6 axis;  ///< twist at a joint velocity of 1, of a mimic joint at 1 of the joint that it follows
    Vector6 twist;
    Vector6 drift;  ///< acceleration from velocities, against that of the parent
    Vector6 momentum;
    OriginInertia inertia;
    OriginInertia composite;  ///< with all that it carries
    Matrix6 articulated;
    Vector6 articulated_force;
    Vector6 effective;  ///< articulated inertia times axis
    double inverse_effective{0};
    double joint_force{0};
    Vector6 acceleration;
    Vector6 force;
  };

  [[nodiscard]] Vector6 felt_gravity() const noexcept;
  void compose() noexcept;
  void forces(const Vector6& base_acceleration, const Coordinates* acceleration, Coordinates& force) noexcept;

  const Model* model_;
  Base base_;
  int first_joint_;  ///< among the coordinates
  Vector3 gravity_{Vector3::Zero()};
  Vector3 base_position_{Vector3::Zero()};
  Matrix3 base_rotation_{Matrix3::Identity()};
  std::vector<Moving> bodies_;
  ByMassMatrix by_matrix_;
};

}  // namespace hirosco::robotics
