// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/endtoend/reads_turn.hpp"

namespace hirosco {
namespace {

struct Turn {
  double position_rad;
  [[nodiscard]] double seen() const noexcept { return position_rad; }
};

std::unique_ptr<Subsystem> make_reads_position() { return std::make_unique<ReadsTurn<Turn>>(); }

}  // namespace
}  // namespace hirosco

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<hirosco::make_reads_position>; }
