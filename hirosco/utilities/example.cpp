// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// A cyclic thread that hands records to another one without ever waiting for it.
#include <cstdio>

#include "hirosco/utilities/allocation_guard.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/record_ring.hpp"

using namespace hirosco;

int main() {
  constexpr std::uint32_t cycles = 20;
  const SystemClock clock;
  RecordRing ring{1024};

  auto loop = Thread::start("loop", [&] {
    if (realtime_permitted()) (void)set_fifo_priority(50);
    TimePoint wake = clock.now();
    for (std::uint32_t cycle = 0; cycle < cycles; ++cycle) {
      sleep_until(wake += 1ms);
      const RealtimeScope scope;  // counts heap uses where hirosco_malloc_hook is linked
      ring.try_write(std::as_bytes(std::span{&cycle, 1}));
    }
  });
  if (!loop) return 1;
  loop->join();

  std::uint32_t seen = 0;
  for (; ring.front(); ring.pop()) ++seen;
  std::printf("%u of %u records, %u dropped\n", seen, cycles, static_cast<unsigned>(ring.dropped()));
  return seen == cycles ? 0 : 1;
}
