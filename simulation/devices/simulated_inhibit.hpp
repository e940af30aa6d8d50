// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/devices/endnode_ways.hpp"

namespace hirosco::simulation {

/// The second inhibit of a simulated device (enable_frame.hpp): payloads reach the motors only while the newest enable command says so,
/// names the epoch of the subsystem's frames and is young enough. By whichever of its ways a command comes, the newest one counts, and what one way has
/// inhibited in an epoch another one enables in a later one only (docs/adr/0237).
/// Pure logic but for its flow. Realtime: bounded, no allocation. Thread: one.
class SimulatedInhibit {
 public:
  /// `endnode`: where it is told; none: there is no such inhibit, and the subsystem's frames suffice. An enable command that is older than `limit`
  /// counts as withdrawn.
  /// `fall_backs`: other ways to it.
  SimulatedInhibit(std::optional<FlowAddress> endnode, Duration limit, std::vector<FlowAddress> fall_backs = {})
      : endnode_{std::move(endnode)}, fall_backs_{std::move(fall_backs)}, limit_{limit} {}

  /// Opens the device's side, once: its other end is never opened a second time.
  [[nodiscard]] Result<> open(FlowFactory& flows);
  /// The ways by which it is told, once it is open; null: it is not, or there is no such inhibit.
  [[nodiscard]] EndnodeWays* ways() noexcept { return ways_.get(); }
  /// Takes what came; to a device that hears nothing, unplugged or without power, it is lost.
  void receive(TimePoint now, bool hears) noexcept;
  /// Answers what was taken, with its sequence; who is unplugged does not.
  void answer(bool plugged, EnableStatus status) noexcept;

  /// Whether payloads of frames of this epoch reach the motors.
  [[nodiscard]] bool enabled(std::uint32_t epoch, TimePoint now) const noexcept;
  /// Whether the supervisor's side has named it, or a later one.
  [[nodiscard]] bool has_named(std::uint32_t epoch) const noexcept {
    return !endnode_ || epoch <= (enable_ ? enable_->epoch : 0);
  }
  /// When the newest command counts as withdrawn; the end of time where there is no such inhibit.
  [[nodiscard]] TimePoint ends_at() const noexcept { return endnode_ ? until_ : TimePoint::max(); }
  [[nodiscard]] std::uint64_t damaged_commands() const noexcept { return damaged_commands_; }

  /// The newest command counts for so much longer.
  void prolong(Duration span) noexcept { until_ += span; }
  /// As if no command had come; one that was taken is answered still.
  void withdraw() noexcept { enable_.reset(); }
  /// It has had no power: it knows nothing of what was before.
  void forget() noexcept;

 private:
  void take(const EnableCommand& command, std::size_t way, TimePoint now) noexcept;

  std::optional<FlowAddress> endnode_;
  std::vector<FlowAddress> fall_backs_;
  Duration limit_;
  std::unique_ptr<EndnodeWays> ways_;
  std::vector<std::optional<std::uint32_t>> asked_;  ///< by each way, and not yet answered
  std::optional<EnableCommand> enable_;  ///< newest that counts
  std::size_t told_by_{0};  ///< that one
  TimePoint until_{};
  std::uint64_t damaged_commands_{0};
};

}  // namespace hirosco::simulation
