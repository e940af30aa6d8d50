// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "robotics/shapes/clearance.hpp"
#include "subsystems/robot_arm/control/abort_way.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

/// Structures of an arm's descriptor: same members, same order; lengths are the descriptor's.
namespace hirosco::robot_arm {

struct CurrentValues {
  std::int32_t state;
  Joints position;
  Joints velocity;
  Joints torque;
  std::uint16_t device_flags;
};
struct ToolValues {
  std::array<double, 3> position_m;
  std::array<double, 4> orientation_wxyz;
};
/// Whoever says no orientation, all 0, has it as the tip.
[[nodiscard]] inline robotics::Pose pose_of(const ToolValues& its) noexcept {
  const robotics::Quaternion turned{its.orientation_wxyz[0], its.orientation_wxyz[1], its.orientation_wxyz[2],
                                    its.orientation_wxyz[3]};
  return {turned.norm() > 0 ? turned.normalized().toRotationMatrix() : robotics::Matrix3{robotics::Matrix3::Identity()},
          {its.position_m[0], its.position_m[1], its.position_m[2]}};
}
[[nodiscard]] inline ToolValues values_of(const robotics::Pose& pose) noexcept {
  const robotics::Quaternion turned{pose.rotation};
  return {{pose.position.x(), pose.position.y(), pose.position.z()}, {turned.w(), turned.x(), turned.y(), turned.z()}};
}
struct MotionValues {
  std::uint8_t kind;  ///< of MOTIONS
  double duration_s;
  double progress;
};
struct PayloadValues {
  double mass_kg;
  std::array<double, 3> place_m;
};
struct ContactValues {
  std::uint8_t reaction;  ///< of REACTIONS
  double limit;  ///< of a joint's effort
};
struct LawValues {
  std::uint8_t kind;  ///< of LAWS
  double stiffness_n_m;
  double turning_n_m;
  double damping;
};
/// Of whoever leads over a real-time link (docs/adr/0179).
struct LeadValues {
  std::uint8_t leading;  ///< of LEADING
  std::uint32_t age_cycles;  ///< of what came last
  double distance;  ///< from the setpoint to where it is led, of the joint that is farthest; rad or m
};
struct LeadLimits {
  double begin;  ///< rad or m
  double distance;
};
/// JOINT_POSITIONS and JOINT_SPEEDS.
struct LedToPositions {
  Joints position;
  Joints velocity;
  std::uint8_t active;
};
struct LedWithSpeeds {
  Joints velocity;
  std::uint8_t active;
};

/// Of single precision, so that eight postures of 16 joints outlive a flight (`persistent`): what they are off by is nothing to an arm.
struct PostureValues {
  Sized<float, max_joints> joints;
};
/// The first COUNT of them are in force.
struct AbortPathValues {
  std::uint8_t count;
  std::array<PostureValues, AbortWay::most> postures;
};

/// Of each volume that is kept out of: two points and a radius.
inline constexpr std::size_t volume_numbers = 7;
using KeepOut = std::array<double, robotics::Clearance::most_volumes * volume_numbers>;

/// One for each joint: 0 or 1.
using JointFlags = Sized<std::uint8_t, max_joints>;
/// Of the search for references, joint by joint (docs/adr/0208).
struct HomingValues {
  JointFlags order;  ///< joints from 1, each once
  Joints speed;  ///< rad/s or m/s; its sign is the way to the mark
  Joints torque;  ///< N m or N that the joint is given at most
  Joints distance;  ///< rad or m within which its mark is
};

struct ArmInput {
  Joints position;
  Joints velocity;
  Joints torque;
};
/// Of an arm whose device tells force and moment at its tip, too: FORCE, MOMENT in the tip's axes, and for how long they have been these, ms.
struct TipForce {
  std::array<double, 3> force_n;
  std::array<double, 3> moment_n_m;
  std::uint32_t age_ms;
};
struct SensingArmInput {
  Joints position;
  Joints velocity;
  Joints torque;
  std::array<double, 3> force_n;
  std::array<double, 3> moment_n_m;
  std::uint32_t age_ms;
};
/// Of one whose device tells which joints know their zero, and takes it at their marks.
struct ReferencedArmInput {
  Joints position;
  Joints velocity;
  Joints torque;
  JointFlags referenced;
};
/// Of one with both.
struct SensingReferencedArmInput {
  Joints position;
  Joints velocity;
  Joints torque;
  std::array<double, 3> force_n;
  std::array<double, 3> moment_n_m;
  std::uint32_t age_ms;
  JointFlags referenced;
};
/// What the sensor at the tip feels from outside, in the axes of the base.
struct WristValues {
  std::array<double, 3> force_n;
  std::array<double, 3> moment_n_m;
  std::uint32_t age_ms;
  std::uint8_t valid;
};
struct WristRange {
  double force_n;
  double moment_n_m;
};
struct ArmOutput {
  Joints torque;
};
/// REFERENCE: this joint takes its zero when it comes to its mark.
struct ReferencedArmOutput {
  Joints torque;
  JointFlags reference;
};

}  // namespace hirosco::robot_arm
