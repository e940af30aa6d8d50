// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/devices/endnode_ways.hpp"

namespace hirosco::simulation {

/// The power switch in front of a simulated device (power_frame.hpp): off until it is told, and again when nobody tells it any more.
/// By whichever of its ways a command comes, the newest one counts (docs/adr/0237).
/// Pure logic but for its flow. Realtime: bounded, no allocation but in open(). Thread: one.
class SimulatedSwitch {
 public:
  /// `endnode`: where it is told; none: there is no switch, and the device has power always, as it has before open().
  /// `fall_backs`: other ways to it.
  explicit SimulatedSwitch(std::optional<FlowAddress> endnode, std::vector<FlowAddress> fall_backs = {})
      : endnode_{std::move(endnode)}, fall_backs_{std::move(fall_backs)} {}
  /// Opens the device's side, once.
  [[nodiscard]] Result<> open(FlowFactory& flows);
  [[nodiscard]] bool opened() const noexcept { return ways_ != nullptr; }
  /// The ways by which it is told, once it is open; null: it is not, or there is no switch.
  [[nodiscard]] EndnodeWays* ways() noexcept { return ways_.get(); }
  /// Takes what came and answers it. True: power came or went.
  [[nodiscard]] bool step(TimePoint now) noexcept;
  [[nodiscard]] bool on() const noexcept { return !opened() || on_; }
  /// When it is off by itself; the end of time while it is off, or there is none.
  [[nodiscard]] TimePoint off_at() const noexcept { return on_ ? until_ : TimePoint::max(); }

 private:
  void take(std::size_t way, TimePoint now) noexcept;

  std::optional<FlowAddress> endnode_;
  std::vector<FlowAddress> fall_backs_;
  std::unique_ptr<EndnodeWays> ways_;
  bool on_{false};
  TimePoint until_{};
  std::size_t told_by_{0};
  std::uint32_t sequence_{0};
};

}  // namespace hirosco::simulation
