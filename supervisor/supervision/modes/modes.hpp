// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"

namespace hirosco::supervisor {

/// SET_MODE: which telecommands are permitted. What was permitted in a mode before is void behind it, by its epoch on every
/// member's page.
class Modes {
 public:
  Modes(Craft& craft, OwnSubsystem& own) : craft_{craft}, own_{own} {}
  void provide();

 private:
  void enter(const descriptor::Mode& mode);
  [[nodiscard]] bool lives(const descriptor::CommissionStep& step) const;

  Craft& craft_;
  OwnSubsystem& own_;
};

}  // namespace hirosco::supervisor
