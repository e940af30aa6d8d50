// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Nearer to it by so much at most.
[[nodiscard]] inline Vector3 towards(const Vector3& now, const Vector3& wanted, double most) noexcept {
  const Vector3 left = wanted - now;
  const double length = left.norm();
  return length > most ? Vector3{now + most / length * left} : wanted;
}

/// Velocities of joints or tool for so long, then to rest (docs/adr/0222): who jogs on says so before. Joints go by the setpoints of the arm that stands, within their ranges, velocities
/// and accelerations; of the tool it is what it is to have, which a law of the tool turns into joints.
/// Realtime: wait-free, but begin(). Thread: the cycle, and the service loop while there is none.
class FloatingJog {
 public:
  /// A tool is as fast as TOOL_SPEED in half a second, which no motion of it exceeds much, and comes to rest in as long.
  static constexpr double tool_m_s2 = 0.1, tool_rad_s2 = 0.1;

  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    const FloatingCraft& craft;
    const FloatingParameters& parameters;
  };
  explicit FloatingJog(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);
  void end() noexcept {
    of_ = Of::Nobody;
    if (setpoints_ && setpoints_->kind() == Setpoints::Kind::Follow) setpoints_->rest(setpoints_->now().position);
  }
  /// For whoever leads joints in its place (Lead); he begins where they rest.
  [[nodiscard]] Setpoints& setpoints() noexcept { return *setpoints_; }

  // --- functions: from now on for so long, from the velocities that it has ------------------------------------------------
  /// Numbers in the order of the descriptor; who does not jog them yet begins there.
  [[nodiscard]] Outcome joints(const FunctionValues& values, const JointVector& from) noexcept;
  /// m/s and rad/s, in the axes of the tool's goal.
  [[nodiscard]] Outcome tool(const std::array<double, 3>& moving_m_s, const std::array<double, 3>& turning_rad_s,
                             double span_s) noexcept;

  /// Joints go no faster from now on than their power permits.
  void keep_power(double limit_w) noexcept {
    setpoints_->keep_power(JointVector::Zero(static_cast<Eigen::Index>(parts_.known.joints())), limit_w);
  }
  /// Each cycle.
  void advance() noexcept;
  [[nodiscard]] bool of_joints() const noexcept { return of_ == Of::AllJoints; }
  [[nodiscard]] bool of_tool() const noexcept { return of_ == Of::Tool; }
  /// Its time is over, and what it led has come to rest.
  [[nodiscard]] bool over() const noexcept;
  /// Where the joints are to be, and how fast.
  [[nodiscard]] const Setpoint& now() const noexcept { return setpoints_->now(); }
  /// How fast the tool is to turn, rad/s, and to move, m/s.
  [[nodiscard]] const Vector3& turning() const noexcept { return turning_; }
  [[nodiscard]] const Vector3& moving() const noexcept { return moving_; }

 private:
  enum class Of : std::uint8_t { Nobody, AllJoints, Tool };

  Parts parts_;
  std::optional<Setpoints> setpoints_;
  Of of_{Of::Nobody};
  double cycle_s_{0.001}, left_s_{0};
  Vector3 wanted_turning_{Vector3::Zero()}, wanted_moving_{Vector3::Zero()};
  Vector3 turning_{Vector3::Zero()}, moving_{Vector3::Zero()};
};

}  // namespace hirosco::robot_arm
