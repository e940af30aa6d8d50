// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::simulation {

/// The power switch in front of a simulated device (power_frame.hpp): off until it is told, and again when nobody tells it any more.
/// Pure logic but for its flow. Realtime: bounded, no allocation. Thread: one.
class SimulatedSwitch {
 public:
  explicit SimulatedSwitch(std::unique_ptr<DataFlow> flow) noexcept : flow_{std::move(flow)} {}
  /// Takes what came and answers it.
  void step(TimePoint now) noexcept;
  [[nodiscard]] bool on() const noexcept { return on_; }
  /// When it is off by itself; the end of time while it is off.
  [[nodiscard]] TimePoint off_at() const noexcept { return on_ ? until_ : TimePoint::max(); }

 private:
  std::unique_ptr<DataFlow> flow_;
  bool on_{false};
  TimePoint until_{};
  std::uint32_t sequence_{0};
};

}  // namespace hirosco::simulation
