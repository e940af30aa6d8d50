// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::communication {

/// The newest octets of one stream, which each of its readers reads at its own pace, by how many it has read since the stream began.
/// Realtime: bounded; memory is taken by the constructor. Thread: one.
class TelemetryRing {
 public:
  explicit TelemetryRing(std::size_t octets) : ring_(octets) {}

  [[nodiscard]] std::size_t size() const noexcept { return ring_.size(); }
  /// Octets since the stream began.
  [[nodiscard]] std::uint64_t written() const noexcept { return written_; }
  /// No longer than the ring; what it takes the place of is lost.
  void put(Octets packet) noexcept {
    const std::size_t start = written_ % ring_.size();
    const std::size_t first_part = std::min(packet.size(), ring_.size() - start);
    copy_octets(packet.first(first_part), MutableOctets{ring_}.subspan(start));
    copy_octets(packet.subspan(first_part), ring_);
    written_ += packet.size();
  }
  /// What follows for who has read so far, as far as it is in one piece; empty: nothing. It is in the ring still.
  [[nodiscard]] Octets after(std::uint64_t read_to) const noexcept {
    const std::size_t start = read_to % ring_.size();
    const std::size_t waiting = static_cast<std::size_t>(written_ - read_to);
    return Octets{ring_}.subspan(start, std::min(waiting, ring_.size() - start));
  }

 private:
  std::vector<std::byte> ring_;
  std::uint64_t written_{0};
};

}  // namespace hirosco::communication
