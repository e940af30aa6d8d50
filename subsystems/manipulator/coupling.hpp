// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/subsystem/author/ports.hpp"
#include "subsystems/manipulator/control/clutch.hpp"
#include "subsystems/manipulator/parameters.hpp"

namespace hirosco::manipulator {

/// The handle that leads over a link, whichever set the configuration requires, and the clutch between it and the arm.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Coupling {
 public:
  /// `parameters`: POS_SCALE says how far the handle leads; CLUTCH tells where they were coupled.
  explicit Coupling(Parameters& parameters) noexcept : parameters_{parameters} {}

  /// For require_link().
  [[nodiscard]] LinkInputPort& port() noexcept { return handle_; }
  /// Of the required set: it has to be `joints` long.
  [[nodiscard]] Result<> check_length(std::size_t joints) const noexcept;

  /// From here the handle moves the setpoint, which is `desired_rad`; where it is enabled first it engages once more.
  void engage(const Joints& desired_rad) noexcept;
  /// Where the setpoint is to be, which is `desired_rad` now; nothing: it holds the last one.
  [[nodiscard]] std::optional<Joints> follow(const Joints& desired_rad) noexcept;

 private:
  void engage_clutch(const Joints& desired_rad) noexcept;

  Parameters& parameters_;
  LinkInput<HandleState> handle_;  ///< whichever set the configuration requires
  Clutch clutch_;
  bool following_{false};
};

}  // namespace hirosco::manipulator
