// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// bench_missed_cycles [CYCLES [LOAD]]: how many of 10^7 cycles of a 500 us loop are missed, and the latest of all: ours (with one link written and
// read in each cycle) beside cyclictest, at the same time on two processors that they swap in each slice. LOAD: so many processes of ordinary
// scheduling work on memory meanwhile. Ends with 1 where cyclictest is installed and fails; where it is not, that is said.
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bench/cyclictest.hpp"
#include "bench/loop.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

constexpr Duration period = 500us;
constexpr std::int64_t period_us = 500;
constexpr int priority = 80;
constexpr int slice_cycles = 100'000;
constexpr std::int64_t told_us =
    20'000;  ///< of those later than this in a slice the latest is told, the others count as so late

/// How late how many cycles were, in whole microseconds.
struct Lateness {
  std::vector<std::uint64_t> counts = std::vector<std::uint64_t>(std::size_t{told_us} + 1);
  std::int64_t max_us{0};
  std::uint64_t missed{0};  ///< cycles that were over before the loop woke up for one before them

  void add(std::int64_t late_us, std::uint64_t times = 1) {
    counts[static_cast<std::size_t>(std::clamp<std::int64_t>(late_us, 0, told_us))] += times;
    max_us = std::max(max_us, late_us);
    missed += static_cast<std::uint64_t>(std::max<std::int64_t>(late_us, 0) / period_us) * times;
  }
  [[nodiscard]] std::uint64_t cycles() const { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }
  [[nodiscard]] std::size_t at(double share) const {
    auto left = static_cast<std::uint64_t>(share * static_cast<double>(cycles()));
    for (std::size_t us = 0; us < counts.size(); ++us) {
      if (counts[us] > left) return us;
      left -= counts[us];
    }
    return std::size_t{told_us};
  }
  /// As it says of a slice of ours what cyclictest says of its own: the same lateness has to be the same number of missed cycles.
  void add_slice(const Lateness& slice) {
    const std::uint64_t beyond = slice.counts[std::size_t{told_us}];
    for (std::size_t us = 0; us < std::size_t{told_us}; ++us)
      if (slice.counts[us] != 0) add(static_cast<std::int64_t>(us), slice.counts[us]);
    if (beyond > 1) add(told_us, beyond - 1);
    if (beyond > 0) add(slice.max_us);
  }
  void print(const std::string& name) const {
    std::printf(
        "%-28s %12llu cycles %12llu missed  p50 %zu  p99 %zu  p99.9 %zu  p99.99 %zu  p99.999 %zu  max %lld us\n",
        name.c_str(), static_cast<unsigned long long>(cycles()), static_cast<unsigned long long>(missed), at(0.5),
        at(0.99), at(0.999), at(0.9999), at(0.99999), static_cast<long long>(max_us));
  }
};

/// Somebody who works on more memory than a cache holds, until whoever started it ends.
pid_t begin_load() {
  const pid_t child = ::fork();
  if (child != 0) return child;
  static_cast<void>(::prctl(PR_SET_PDEATHSIG, SIGKILL));
  std::vector<std::uint64_t> words(std::size_t{8} << 20);
  for (std::uint64_t round = 1;; ++round)
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = words[words.size() - 1 - i] * round + i;
}

int run(std::uint64_t cycles, int load) {
  std::vector<pid_t> loads;
  for (int i = 0; i < load; ++i) loads.push_back(begin_load());
  const SystemClock clock;
  // As cyclictest does: no deep sleep of the processor while we measure.
  const FileDescriptor latency{::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)};
  const std::int32_t none = 0;
  const bool awake = latency && ::write(latency.get(), &none, sizeof none) == sizeof none;
  (void)lock_memory();
  const bool realtime = realtime_permitted();
  const bool apart = std::thread::hardware_concurrency() > 1;
  Lateness ours;
  Lateness cyclictest;
  const bool beside = Cyclictest::installed();
  bool failed = false;
  for (std::uint64_t done = 0, slice = 0; done < cycles; ++slice) {
    const int now = static_cast<int>(std::min<std::uint64_t>(cycles - done, slice_cycles));
    const int mine = apart ? static_cast<int>(slice % 2) : 0;
    std::optional<Cyclictest> other;
    if (beside)
      other.emplace(CyclictestTerms{.cycles = now,
                                    .period_us = period_us,
                                    .told_us = told_us,
                                    .processor = apart ? 1 - mine : 0,
                                    .priority = realtime ? priority : 0});
    bool told = true;
    const auto hear = [&] {
      if (other) told = other->read([&](std::int64_t late_us, std::uint64_t times) { cyclictest.add(late_us, times); });
    };
    if (!apart) hear();
    // Its start is no part of what is compared.
    if (apart) static_cast<void>(rest_until(clock.now() + 200ms, {}, clock));
    (void)pin_to_cpu(mine);
    if (realtime) (void)set_fifo_priority(priority);
    Lateness slice_of_ours;
    run_loop(clock, period, now, {}, [&](Duration by) {
      slice_of_ours.add(std::chrono::duration_cast<std::chrono::microseconds>(by).count());
    });
    (void)set_ordinary_scheduling();
    ours.add_slice(slice_of_ours);
    if (apart) hear();
    if (!told) {
      std::fputs("cyclictest is installed and told nothing, or ended with an error: run it by hand to see why\n",
                 stderr);
      failed = true;
      break;
    }
    done += static_cast<std::uint64_t>(now);
    if (slice % 10 == 9) {
      std::fprintf(stderr, "%llu cycles: missed %llu, cyclictest %llu\n", static_cast<unsigned long long>(done),
                   static_cast<unsigned long long>(ours.missed), static_cast<unsigned long long>(cyclictest.missed));
    }
  }
  for (const pid_t one : loads) {
    ::kill(one, SIGKILL);
    ::waitpid(one, nullptr, 0);
  }
  if (failed) return EXIT_FAILURE;
  std::printf("Lateness of a 500 us loop, %s%s, %d at work beside it\n",
              realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)", awake ? ", no deep idle" : "",
              load);
  const std::string when = load > 0 ? ", under load" : ", idle";
  ours.print("ours" + when);
  if (!beside) {
    std::puts("cyclictest (rt-tests) is not installed");
    return EXIT_SUCCESS;
  }
  cyclictest.print("cyclictest" + when);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const std::uint64_t cycles = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
  return hirosco::bench::run(cycles, argc > 2 ? std::atoi(argv[2]) : 0);
}
