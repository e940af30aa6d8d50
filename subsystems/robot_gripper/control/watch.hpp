// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "robotics/limits/two_of_three.hpp"
#include "subsystems/robot_gripper/control/fingers.hpp"

/// What stops a gripper by its own sensors, in every state.
namespace hirosco::robot_gripper {

enum class Excess : std::uint8_t { Position, Speed, Force };
inline constexpr std::size_t excesses = 3;

/// What was too much: joint from 0, what was measured, and the limit.
struct Finding {
  Excess what{};
  std::size_t joint{0};
  double value{0};
  double limit{0};
};

/// Trips when two of the last three samples of a joint are beyond a limit. What is no number is beyond every limit. Each kind is told
/// once, until it is armed anew.
class Watch {
 public:
  struct Limits {
    double past_end_share{0.05};  ///< of the joint's range, beyond it
    double speed_share{1.1};  ///< of its velocity
    double force_share{0.95};  ///< of its effort
  };
  void arm() noexcept { *this = {}; }
  [[nodiscard]] std::optional<Finding> update(const Measured& measured, const Fingers& fingers,
                                              const Limits& limits) noexcept;
  [[nodiscard]] bool tripped() const noexcept { return tripped_; }

 private:
  std::array<std::array<robotics::TwoOfThree, max_fingers>, excesses> history_{};
  std::array<bool, excesses> told_{};
  bool tripped_{false};
};

}  // namespace hirosco::robot_gripper
