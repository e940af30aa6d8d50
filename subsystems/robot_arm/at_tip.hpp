// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/limit_watch.hpp"
#include "subsystems/robot_arm/on_board_model.hpp"
#include "subsystems/robot_arm/tool_and_payload.hpp"
#include "subsystems/robot_arm/torque_control.hpp"

namespace hirosco::robot_arm {

/// What an arm on a base that stands has at its tip (ToolAndPayload): whoever goes by it is told.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class AtTip {
 public:
  struct Parts {
    const LimitWatch& limits;
    OnBoardModel& model;
    ToolAndPayload& carried;
    Guidance& guidance;
    TorqueControl& control;
  };
  explicit AtTip(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure(), behind those that go by it.
  void begin() noexcept;

  // --- functions; `called`: a motion or STOP is under way -----------------------------------------------------------------
  /// A load that is not there would lift who is led or soft; the law of positions keeps its place whatever is declared.
  [[nodiscard]] Outcome take_payload(double mass_kg, const std::array<double, 3>& place_m, bool called) noexcept;
  [[nodiscard]] Outcome take_tool(const ToolValues& in_tip, bool called) noexcept;

 private:
  void place_tool() noexcept;

  Parts parts_;
};

}  // namespace hirosco::robot_arm
