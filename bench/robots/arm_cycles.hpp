// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/figures.hpp"
#include "bench/robots/robot_cases.hpp"

/// How long the cycles of an arm take beside their period, while it moves with inverse dynamics, observer and collision check (docs/adr/0186).
namespace hirosco::bench {

/// At p99, of the period.
inline constexpr double most_of_a_period = 0.1;

struct ArmCycles {
  double period_us{0};
  /// Of each cycle in which it moved: what the thread used of its processor, and what passed meanwhile, ns.
  std::vector<std::int64_t> processor_ns, wall_ns;
  /// What was on in them, as the arm tells in motion.
  int told{0};  ///< so often
  bool by_positions{true};  ///< the law in force, which is computed torque
  bool watches_contact{true};
  double most_external{0};  ///< that its observer found in a joint, N m or N
  double least_clearance_m{HUGE_VAL};  ///< between its links; infinite: nobody looked, or there is nothing to look at
  std::vector<std::string> problems;  ///< of flights

  /// us
  [[nodiscard]] Figures processor() const { return figures_of(processor_ns); }
  [[nodiscard]] Figures wall() const { return figures_of(wall_ns); }
  /// What of the period a cycle uses of the processor at p99.
  [[nodiscard]] double share() const { return processor().p99 / period_us; }
  /// What keeps the figures from being those of an arm with all of it; empty: nothing.
  [[nodiscard]] std::vector<std::string> missing() const;
  [[nodiscard]] bool holds() const;

 private:
  [[nodiscard]] static Figures figures_of(std::vector<std::int64_t> ns) { return bench::figures_of(ns, 1e-3); }
};

/// Flies it to its goals and along its lines again, each time by the next seed, until so many cycles in motion are measured.
[[nodiscard]] ArmCycles measure_arm_cycles(const std::filesystem::path& mission, const RobotTask& task,
                                           std::size_t cycles, std::uint64_t seed);

}  // namespace hirosco::bench
