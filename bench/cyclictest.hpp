// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

/// cyclictest (rt-tests) as the peer of our loops: the same period, processor and priority, as a process of its own.
namespace hirosco::bench {

/// What it is asked for.
struct CyclictestTerms {
  int cycles{};
  std::int64_t period_us{};
  std::int64_t told_us{};  ///< its histogram goes so far
  int processor{};
  int priority{};  ///< of SCHED_FIFO; 0: ordinary scheduling
};

/// One run of it, which has begun.
class Cyclictest {
 public:
  /// Whether there is one. Whoever has it and gets nothing from it has failed, and has not left it out.
  [[nodiscard]] static bool installed() {
    const char* const path = std::getenv("PATH");
    std::istringstream folders{path != nullptr ? path : ""};
    for (std::string folder; std::getline(folders, folder, ':');)
      if (::access((folder + "/cyclictest").c_str(), X_OK) == 0) return true;
    return false;
  }
  explicit Cyclictest(const CyclictestTerms& terms) : told_us_{terms.told_us} {
    std::string command = "cyclictest -q -t1 -i" + std::to_string(terms.period_us) + " -h" +
                          std::to_string(terms.told_us) + " -l" + std::to_string(terms.cycles) + " -a" +
                          std::to_string(terms.processor);
    command += terms.priority > 0 ? " -m -p" + std::to_string(terms.priority) : " --policy=other";
    output_ = ::popen((command + " 2>/dev/null").c_str(), "r");
  }
  Cyclictest(const Cyclictest&) = delete;
  Cyclictest& operator=(const Cyclictest&) = delete;
  ~Cyclictest() {
    if (output_ != nullptr) (void)::pclose(output_);
  }

  /// Waits for its end. `row(late_us, cycles)` has its histogram; of those beyond it one was as late as its latest, the others
  /// count as late as it goes: that is in its favour. False: it told nothing, or ended with an error.
  [[nodiscard]] bool read(auto&& row) {
    if (output_ == nullptr) return false;
    std::array<char, 256> line{};
    long long overflows = 0, max_us = 0;
    bool any = false;
    while (std::fgets(line.data(), static_cast<int>(line.size()), output_) != nullptr) {
      long long late_us = 0, cycles = 0;
      if (std::sscanf(line.data(), "%lld %lld", &late_us, &cycles) == 2) {
        if (cycles > 0) row(late_us, static_cast<std::uint64_t>(cycles));
        any = any || cycles > 0;
      } else if (std::sscanf(line.data(), "# Histogram Overflows: %lld", &cycles) == 1) {
        overflows = cycles;
      } else if (std::sscanf(line.data(), "# Max Latencies: %lld", &late_us) == 1) {
        max_us = late_us;
      }
    }
    if (overflows > 1) row(told_us_, static_cast<std::uint64_t>(overflows - 1));
    if (overflows > 0) row(std::max<std::int64_t>(max_us, told_us_), std::uint64_t{1});
    const bool ended_well = ::pclose(output_) == 0;
    output_ = nullptr;
    return ended_well && (any || overflows > 0);
  }

 private:
  std::int64_t told_us_;
  std::FILE* output_{nullptr};
};

}  // namespace hirosco::bench
