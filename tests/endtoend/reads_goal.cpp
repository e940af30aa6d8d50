// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/endtoend/reads_turn.hpp"

/// The next version of reads_position.cpp, which reads a field more.
namespace hirosco {
namespace {

constexpr double told_apart_rad = 10.0;  ///< from every position

struct Turn {
  double position_rad;
  double goal_rad;
  [[nodiscard]] double seen() const noexcept { return goal_rad + told_apart_rad; }
};

std::unique_ptr<Subsystem> make_reads_goal() { return std::make_unique<ReadsTurn<Turn>>(); }

}  // namespace
}  // namespace hirosco

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<hirosco::make_reads_goal>; }
