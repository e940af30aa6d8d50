// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/packet/packet_counters.hpp"

#include <algorithm>
#include <span>

namespace hirosco::pus {

void PacketCounters::stamp(TelemetryHeader& header) noexcept {
  header.sequence_count = static_cast<std::uint16_t>(block_->sequence % sequence_counts);
  block_->sequence = static_cast<std::uint16_t>((header.sequence_count + 1U) % sequence_counts);
  // The block may come from shared memory: its own count of entries is not trusted.
  const std::size_t used = std::min<std::size_t>(block_->used, block_->types.size());
  const auto known = std::span{block_->types}.first(used);
  auto entry = std::ranges::find_if(known, [&header](const CounterBlock::MessageType& type) {
    return type.destination == header.destination && type.service == header.service && type.subtype == header.subtype;
  });
  header.message_count = 0;
  if (entry != known.end()) {
    header.message_count = entry->count++;
    return;
  }
  if (used == block_->types.size()) return;
  block_->types[used] = {header.destination, header.service, header.subtype, 1, 0};
  block_->used = static_cast<std::uint32_t>(used + 1);
}

}  // namespace hirosco::pus
