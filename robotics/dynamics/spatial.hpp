// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Robots as rigid bodies: what subsystems and planners reckon with. Right-handed axes, SI units, radians.
namespace hirosco::robotics {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;
/// A twist [ω; v], rad/s and m/s, or a wrench [n; f], N m and N. v is the velocity of the origin, n the moment about it.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Where one frame stands in another: p_other = rotation p_this + position.
struct Pose {
  Matrix3 rotation{Matrix3::Identity()};
  Vector3 position{Vector3::Zero()};
};

/// Realtime: wait-free, like all below.
[[nodiscard]] inline Pose operator*(const Pose& outer, const Pose& inner) noexcept {
  return {outer.rotation * inner.rotation, outer.position + outer.rotation * inner.position};
}
[[nodiscard]] inline Vector3 operator*(const Pose& pose, const Vector3& point) noexcept {
  return pose.position + pose.rotation * point;
}
[[nodiscard]] inline Pose inverse(const Pose& pose) noexcept {
  return {pose.rotation.transpose(), -(pose.rotation.transpose() * pose.position)};
}

/// cross_matrix(a) b = a × b.
[[nodiscard]] inline Matrix3 cross_matrix(const Vector3& a) noexcept {
  Matrix3 matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

/// How a twist changes what moves with another one.
[[nodiscard]] inline Vector6 cross_twist(const Vector6& twist, const Vector6& moved) noexcept {
  Vector6 result;
  result.head<3>() = twist.head<3>().cross(moved.head<3>());
  result.tail<3>() = twist.head<3>().cross(moved.tail<3>()) + twist.tail<3>().cross(moved.head<3>());
  return result;
}

/// How a twist changes a wrench or momentum that moves with it.
[[nodiscard]] inline Vector6 cross_wrench(const Vector6& twist, const Vector6& moved) noexcept {
  Vector6 result;
  result.head<3>() = twist.head<3>().cross(moved.head<3>()) + twist.tail<3>().cross(moved.tail<3>());
  result.tail<3>() = twist.head<3>().cross(moved.tail<3>());
  return result;
}

/// A rigid body's mass and how it is distributed, in a frame of the body.
struct Inertia {
  double mass{0};  ///< kg
  Vector3 centre{Vector3::Zero()};  ///< of mass, m
  Matrix3 about_centre{Matrix3::Zero()};  ///< kg m2, symmetric
};

/// Both bodies as one.
[[nodiscard]] inline Inertia operator+(const Inertia& one, const Inertia& other) noexcept {
  Inertia sum;
  sum.mass = one.mass + other.mass;
  sum.about_centre = one.about_centre + other.about_centre;
  if (sum.mass <= 0) return sum;
  sum.centre = (one.mass * one.centre + other.mass * other.centre) / sum.mass;
  const Vector3 apart = one.centre - other.centre;
  sum.about_centre +=
      one.mass * other.mass / sum.mass * (apart.squaredNorm() * Matrix3::Identity() - apart * apart.transpose());
  return sum;
}

/// The same body, seen from the frame in which `pose` places its own.
[[nodiscard]] inline Inertia moved(const Pose& pose, const Inertia& inertia) noexcept {
  return {inertia.mass, pose * inertia.centre, pose.rotation * inertia.about_centre * pose.rotation.transpose()};
}

/// The same about the origin of the frame, which is what adds up and what maps twists to momenta.
struct OriginInertia {
  double mass{0};
  Vector3 first_moment{Vector3::Zero()};  ///< mass times centre, kg m
  Matrix3 about_origin{Matrix3::Zero()};  ///< kg m2, symmetric

  OriginInertia() = default;
  explicit OriginInertia(const Inertia& inertia) noexcept
      : mass{inertia.mass},
        first_moment{inertia.mass * inertia.centre},
        about_origin{inertia.about_centre - first_moment * inertia.centre.transpose()} {
    about_origin.diagonal().array() += first_moment.dot(inertia.centre);
  }
  OriginInertia& operator+=(const OriginInertia& other) noexcept {
    mass += other.mass;
    first_moment += other.first_moment;
    about_origin += other.about_origin;
    return *this;
  }
  /// The momentum [angular about the origin; linear] of this body at a twist.
  [[nodiscard]] Vector6 operator*(const Vector6& twist) const noexcept {
    Vector6 momentum;
    momentum.head<3>() = about_origin * twist.head<3>() + first_moment.cross(twist.tail<3>());
    momentum.tail<3>() = mass * twist.tail<3>() - first_moment.cross(twist.head<3>());
    return momentum;
  }
  [[nodiscard]] Matrix6 matrix() const noexcept {
    const Matrix3 cross = cross_matrix(first_moment);
    Matrix6 result;
    result.topLeftCorner<3, 3>() = about_origin;
    result.topRightCorner<3, 3>() = cross;
    result.bottomLeftCorner<3, 3>() = -cross;
    result.bottomRightCorner<3, 3>() = mass * Matrix3::Identity();
    return result;
  }
};

}  // namespace hirosco::robotics
