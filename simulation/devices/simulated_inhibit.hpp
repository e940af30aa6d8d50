// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::simulation {

/// The second inhibit of a simulated device (enable_frame.hpp): payloads reach the motors only while the newest enable command says so,
/// names the epoch of the subsystem's frames and is young enough.
/// Pure logic but for its flow. Realtime: bounded, no allocation. Thread: one.
class SimulatedInhibit {
 public:
  /// `endnode`: where it is told; none: there is no such inhibit, and the subsystem's frames suffice. An enable command that is older than `limit`
  /// counts as withdrawn.
  SimulatedInhibit(std::optional<FlowAddress> endnode, Duration limit) : endnode_{std::move(endnode)}, limit_{limit} {}

  /// Opens the device's side, once: its other end is never opened a second time.
  [[nodiscard]] Result<> open(FlowFactory& flows);
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
  std::optional<FlowAddress> endnode_;
  Duration limit_;
  std::unique_ptr<DataFlow> flow_;
  std::optional<EnableCommand> enable_;  ///< newest that counts
  TimePoint until_{};
  std::optional<std::uint32_t> asked_;  ///< not yet answered
  std::uint64_t damaged_commands_{0};
};

}  // namespace hirosco::simulation
