// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "robotics/limits/two_of_three.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

/// What stops an arm by its own sensors, in every state.
namespace hirosco::robot_arm {

enum class Excess : std::uint8_t { Position, Speed, Torque, TorqueHard, Following };
inline constexpr std::size_t excesses = 5;

/// What was too much: joint from 0, what was measured, and the limit.
struct Finding {
  Excess what{};
  std::size_t joint{0};
  double value{0};
  double limit{0};
};

/// Trips when two of the last three samples of a joint are beyond a limit: one disturbed sample does not stop a mission. What is no
/// number is beyond every limit. Each kind is told once, until it is armed anew.
class Watch {
 public:
  struct Limits {
    double past_end{0.02};  ///< rad or m beyond the joint's range, and no more than this share of it
    double speed_share{1.1};  ///< of its velocity
    double torque_share{0.8};  ///< of its effort, that is told softly
    double torque_hard_share{0.95};
    double following{0.1};  ///< rad or m between setpoint and joint
    std::uint32_t without_zero{0};  ///< bit n: what is measured of joint n is no place of its range
  };
  void arm() noexcept { *this = {}; }
  /// What is to be told now, the gravest first; nothing mostly. `setpoint` null: nobody is to follow it.
  [[nodiscard]] std::optional<Finding> update(const Measured& measured, const JointVector* setpoint, Bounds bounds,
                                              const Limits& limits) noexcept;
  /// Something was told since it was armed.
  [[nodiscard]] std::optional<Excess> tripped() const noexcept { return first_; }

 private:
  std::array<std::array<robotics::TwoOfThree, max_joints>, excesses> history_{};
  std::array<bool, excesses> told_{};
  std::optional<Excess> first_{};
};

}  // namespace hirosco::robot_arm
