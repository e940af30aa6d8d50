// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "robotics/limits/two_of_three.hpp"
#include "subsystems/robot_arm/control/work_bounds.hpp"

namespace hirosco::robot_arm {

enum class Work : std::uint8_t { ToolForce, Power, ToolPower };
inline constexpr std::size_t works = 3;

/// What was too much, N or W.
struct WorkFinding {
  Work what{};
  double value{0};
  double limit{0};
};

/// Trips as Watch does: when two of the last three samples are beyond a limit; what is no number is beyond every one. Each is told once, until
/// it is armed anew.
class WorkWatch {
 public:
  struct Is {
    double force_n{0};
    double power_w{0};
    double tool_power_w{0};
  };
  void arm() noexcept { *this = {}; }
  /// What is to be told now; nothing mostly. `feels`: what acts on the tool is known, which it is not while brakes hold the arm.
  [[nodiscard]] std::optional<WorkFinding> update(const Is& is, const WorkLimits& limits, bool feels) noexcept;
  /// Something was told since it was armed.
  [[nodiscard]] bool tripped() const noexcept { return tripped_; }

 private:
  std::array<robotics::TwoOfThree, works> history_{};
  std::array<bool, works> told_{};
  bool tripped_{false};
};

}  // namespace hirosco::robot_arm
