// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::ground {

/// The stream of telemetry: packets out of octets that come in pieces of any size, and what is missing between them.
/// No I/O. Thread: one.
class Downlink {
 public:
  struct Hearers {
    std::function<void(const pus::TelemetryView& packet, Octets octets)> packet;
    /// Told before the packet behind it.
    std::function<void(OnboardTime from, OnboardTime to)> gap;
  };
  explicit Downlink(Hearers hearers) : hearers_{std::move(hearers)} {}

  /// A new stream. What came before it ended at `known_until`: from there to its first packet something may be missing.
  void begin(std::optional<OnboardTime> known_until);
  /// False: this is no telemetry, close the link.
  [[nodiscard]] bool receive(Octets octets);

  [[nodiscard]] std::uint64_t received() const noexcept { return received_; }
  /// By the gaps in the counts of each APID.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  [[nodiscard]] std::uint64_t damaged() const noexcept { return damaged_; }

 private:
  void take(Octets octets);
  void count_lost(const pus::TelemetryView& packet);

  Hearers hearers_;
  std::vector<std::byte> stream_;
  std::optional<OnboardTime> known_until_;  ///< of the time before this stream; empty from its first packet on
  std::map<std::uint16_t, std::pair<std::uint16_t, OnboardTime>> expected_;  ///< by APID: next count, last time
  std::uint64_t received_{0}, lost_{0}, damaged_{0};
};

}  // namespace hirosco::ground
