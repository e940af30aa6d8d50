// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// How late a periodic loop wakes up: ours (with one link written and read in each cycle), once as every cycle rests and once as a precise one
// does (docs/adr/0104), against a bare absolute sleep and cyclictest, in turns.
#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include "bench/cyclictest.hpp"
#include "bench/figures.hpp"
#include "bench/loop.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

constexpr Duration period = 500us;
constexpr int priority = 80;

/// Of a precise cycle: more than wake-ups take but for one in a thousand, less than half of the period.
constexpr Duration spin = 200us;

Figures measure_ours(const Clock& clock, int cycles, const CycleWait& wait) {
  std::vector<std::int64_t> late;
  late.reserve(static_cast<std::size_t>(cycles));
  run_loop(clock, period, cycles, wait, [&](Duration by) { late.push_back(by.count()); });
  return figures_of(late, 1e-3);
}

std::int64_t to_ns(const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; }

/// Nothing but the system call.
Figures measure_bare(int cycles) {
  std::vector<std::int64_t> late;
  late.reserve(static_cast<std::size_t>(cycles));
  timespec now{};
  (void)::clock_gettime(CLOCK_MONOTONIC, &now);
  std::int64_t wake = to_ns(now) + period.count();
  for (int i = 0; i < cycles; ++i) {
    const timespec at{wake / 1'000'000'000, wake % 1'000'000'000};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {}
    (void)::clock_gettime(CLOCK_MONOTONIC, &now);
    late.push_back(to_ns(now) - wake);
    do wake += period.count();
    while (wake <= to_ns(now));
  }
  return figures_of(late, 1e-3);
}

/// The histogram of cyclictest (whole microseconds), as samples. Empty: it failed.
std::optional<Figures> measure_cyclictest(int cycles, bool realtime) {
  constexpr std::int64_t told_us = 5000;
  Cyclictest peer{{.cycles = cycles,
                   .period_us = period / 1us,
                   .told_us = told_us,
                   .processor = 0,
                   .priority = realtime ? priority : 0}};
  std::vector<std::int64_t> late;
  const bool told = peer.read([&](std::int64_t late_us, std::uint64_t times) {
    late.insert(late.end(), static_cast<std::size_t>(times), late_us);
  });
  if (!told) return std::nullopt;
  return figures_of(late, 1.0);
}

int run(int repeats, int cycles) {
  const SystemClock clock;
  // As cyclictest does: no deep sleep of the processor while we measure.
  const FileDescriptor latency{::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)};
  const std::int32_t none = 0;
  const bool awake = latency && ::write(latency.get(), &none, sizeof none) == sizeof none;
  (void)lock_memory();
  (void)pin_to_cpu(0);
  const bool realtime = set_fifo_priority(priority).has_value();
  const bool beside = Cyclictest::installed();
  Series ours{"ours", {}};
  Series precise{"ours, precise", {}};
  Series bare{"bare", {}};
  Series cyclictest{"cyclictest", {}};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    ours.repeats.push_back(measure_ours(clock, cycles, {}));
    precise.repeats.push_back(measure_ours(clock, cycles, {.spin = spin}));
    bare.repeats.push_back(measure_bare(cycles));
    if (!beside) continue;
    const auto figures = measure_cyclictest(cycles, realtime);
    if (!figures) {
      std::fputs("cyclictest is installed and told nothing, or ended with an error: run it by hand to see why\n",
                 stderr);
      return EXIT_FAILURE;
    }
    cyclictest.repeats.push_back(*figures);
  }
  std::printf("Lateness of a 500 us loop, %d cycles, median of %d repeats, %s%s\n", cycles, repeats,
              realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)", awake ? ", no deep idle" : "");
  ours.print("us");
  precise.print("us");
  bare.print("us");
  ours.print_ratio(bare);
  if (!beside) {
    std::puts("cyclictest (rt-tests) is not installed");
    return EXIT_SUCCESS;
  }
  cyclictest.print("us");
  ours.print_ratio(cyclictest);
  cyclictest.print_ratio(precise);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 7;
  const int cycles = argc > 2 ? std::atoi(argv[2]) : 4'000;
  return hirosco::bench::run(repeats, cycles);
}
