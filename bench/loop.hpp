// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/subsystem/process/cycle_rest.hpp"
#include "hirosco/utilities/os/clock.hpp"

namespace hirosco::bench {

/// `cycles` of a loop as a subsystem's cycle is: what it rests by, its clock, and a link of 256 octets written and read in each.
/// `is_late(Duration)` has how late each was; a missed cycle is not made up for.
void run_loop(const Clock& clock, Duration period, int cycles, const CycleWait& wait, auto&& is_late) {
  constexpr std::uint32_t payload_octets = 256;
  HeapMemory provider;
  const LinkLayout layout{1, payload_octets, 1, period};
  const Mapping memory =
      provider.map(provider.create("link", link_memory_octets(payload_octets)).value(), Access::ReadWrite).value();
  LatestWriter writer = LatestWriter::make(memory.octets, layout).value();
  LatestReader reader = LatestReader::make(memory.octets, layout).value();
  std::array<std::byte, payload_octets> payload{};
  TimePoint wake = clock.now() + period;
  for (int i = 0; i < cycles; ++i) {
    static_cast<void>(rest_until(wake, wait, clock));
    const TimePoint now = clock.now();
    is_late(now - wake);
    writer.write(payload, now, LinkStatus::Valid);
    (void)reader.read(payload);
    do wake += period;
    while (wake <= now);
  }
}

}  // namespace hirosco::bench
