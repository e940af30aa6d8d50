// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// How late a periodic loop wakes up: ours (with one link written and read in each cycle), once as every cycle rests and once as a precise one
// does (docs/adr/0104), against a bare absolute sleep and cyclictest, in turns.
#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

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

/// The histogram of cyclictest (whole microseconds), as samples.
Figures measure_cyclictest(int cycles, bool realtime) {
  std::string command = "cyclictest -q -t1 -a0 -i500 -h5000 -l" + std::to_string(cycles);
  command += realtime ? " -m -p" + std::to_string(priority) : " --policy=other";
  std::FILE* const output = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (output == nullptr) return {};
  std::vector<std::int64_t> late;
  std::array<char, 256> row{};
  long long overflows = 0;
  while (std::fgets(row.data(), static_cast<int>(row.size()), output) != nullptr) {
    long long at = 0;
    long long count = 0;
    if (std::sscanf(row.data(), "%lld %lld", &at, &count) == 2) {
      late.insert(late.end(), static_cast<std::size_t>(count), at);
    } else if (std::sscanf(row.data(), "# Histogram Overflows: %lld", &count) == 1) {
      overflows = count;
    } else if (std::sscanf(row.data(), "# Max Latencies: %lld", &at) == 1 && overflows == 0 && !late.empty()) {
      late.back() = at;
    }
  }
  (void)::pclose(output);
  late.insert(late.end(), static_cast<std::size_t>(overflows), 5000);
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
  Series ours{"ours", {}};
  Series precise{"ours, precise", {}};
  Series bare{"bare", {}};
  Series cyclictest{"cyclictest", {}};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    ours.repeats.push_back(measure_ours(clock, cycles, {}));
    precise.repeats.push_back(measure_ours(clock, cycles, {.spin = spin}));
    bare.repeats.push_back(measure_bare(cycles));
    if (const Figures figures = measure_cyclictest(cycles, realtime); figures.max > 0)
      cyclictest.repeats.push_back(figures);
  }
  std::printf("Lateness of a 500 us loop, %d cycles, median of %d repeats, %s%s\n", cycles, repeats,
              realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)", awake ? ", no deep idle" : "");
  ours.print("us");
  precise.print("us");
  bare.print("us");
  ours.print_ratio(bare);
  if (cyclictest.repeats.empty()) {
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
