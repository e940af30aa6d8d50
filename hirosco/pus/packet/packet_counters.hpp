// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::pus {

/// Telemetry counts of one APID, as plain data: in the vital page they outlive the process (decision 8b). All zero is the
/// valid beginning.
struct CounterBlock {
  static constexpr std::size_t max_message_types = 64;
  struct MessageType {
    std::uint16_t destination;
    std::uint8_t service;
    std::uint8_t subtype;
    std::uint16_t count;  ///< of the next message
    std::uint16_t spare;
  };
  std::uint32_t used;  ///< entries of `types`
  std::uint16_t sequence;  ///< of the next packet, modulo 16384
  std::uint16_t spare;
  std::array<MessageType, max_message_types> types;
};
static_assert(std::is_trivially_copyable_v<CounterBlock> && std::is_standard_layout_v<CounterBlock> &&
              sizeof(CounterBlock) == 8 + 8 * CounterBlock::max_message_types);

/// Stamps telemetry of one APID with its sequence count and with the message type counter of its destination, service and
/// subtype (docs/interfaces/packets.md). From the 65th such type on the counter is 0, which says "unsupported".
/// Realtime: bounded, does not allocate. Thread: one.
class PacketCounters {
 public:
  /// `block` outlives this object; what it holds is continued.
  explicit PacketCounters(CounterBlock& block) noexcept : block_{&block} {}

  /// Fills in `sequence_count` and `message_count` and counts both on.
  void stamp(TelemetryHeader& header) noexcept;

 private:
  CounterBlock* block_;
};

}  // namespace hirosco::pus
