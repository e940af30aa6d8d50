// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {

/// Where the tool of a craft that floats is to be, and its base where that is to stay unturned; and how far the tool is from there.
/// Realtime: wait-free. Thread: the cycle, and the service loop while there is none.
class KeptTool {
 public:
  struct Parts {
    const FloatingCraft& craft;
    FloatingParameters& parameters;  ///< ERR
  };
  explicit KeptTool(const Parts& parts) noexcept : parts_{parts} {}

  [[nodiscard]] const ToolGoal& goal() const noexcept { return goal_; }
  /// Where it is, it is to be.
  void keep() noexcept { goal_ = {parts_.craft.tool(), Vector3::Zero()}, pace_ = 0; }
  /// It goes no farther than it was to be.
  void rest() noexcept { goal_ = {goal_.pose}, pace_ = 0; }
  /// Joints go as no law of the tool has them: what AttitudeHold keeps behind that is what is then.
  void let_base_go() noexcept { base_let_go_ = true; }
  /// That is now.
  void keep_base() noexcept;
  [[nodiscard]] const robotics::Matrix3& base() const noexcept { return base_; }

  /// From where it is to be, so far.
  void begin_course(const Vector3& offset_m, double duration_s, const PreferredPosture& preferred) noexcept;
  void go(const Course& at) noexcept;
  /// Whether the goal waits for its tool: what is nowhere near that is no goal of a law of velocities, whose joints may be as fast as they may, or near a posture in which they cannot. Of springs it is.
  enum class Leash : std::uint8_t { Waits, Goes };
  /// On by a cycle with these velocities.
  void lead(const Vector3& turning_rad_s, const Vector3& moving_m_s, double cycle_s, Leash leash) noexcept;
  /// Joint velocities for it.
  [[nodiscard]] JointVector rates(Bounds bounds) const noexcept;

  /// Each cycle.
  void measure(double cycle_s) noexcept;
  /// What was measured was of another goal.
  void forget_error() noexcept;
  /// m, without the noise of single samples.
  [[nodiscard]] double error_m() const noexcept { return error_m_; }
  void tell() noexcept;

 private:
  Parts parts_;
  ToolGoal goal_;
  Vector3 from_{Vector3::Zero()}, offset_{Vector3::Zero()};
  robotics::Matrix3 base_{robotics::Matrix3::Identity()};
  bool base_let_go_{false};
  PreferredPosture preferred_;
  double duration_s_{0};
  double pace_{0};  ///< of its full speed
  Vector3 mean_left_m_{Vector3::Zero()};
  double error_m_{0};
};

}  // namespace hirosco::robot_arm
