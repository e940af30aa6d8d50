// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "supervisor/supervision/procedures/engine.hpp"

namespace hirosco::supervisor {

/// From where subsystems are to where a mode wants them, as stages of a procedure: what is the same already is left out. A
/// configuration that requires its self test runs it before Operational.
class Way {
 public:
  void add(const descriptor::Subsystem& subsystem, const descriptor::Configuration& configuration,
           std::optional<State> from, State to);
  /// A link of the mission; made between Pre-Operational and Safe-Operational (docs/adr/0021).
  void link(std::uint8_t id);
  /// At the end.
  void enter(const descriptor::Mode& mode);
  [[nodiscard]] std::vector<Stage> stages() const {
    return {down_, pre_, configure_, link_, safe_, self_test_, operational_, mode_};
  }

 private:
  Stage down_, pre_, configure_, link_, safe_, self_test_, operational_, mode_;
};

}  // namespace hirosco::supervisor
