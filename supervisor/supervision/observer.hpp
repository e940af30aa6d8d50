// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/supervision/succession/journal.hpp"

namespace hirosco::supervisor {

/// Who wants to see what happens: a console, a test. Called in the supervisor's thread; must not block. What it is to know beyond this
/// supervisor it notes; most know nothing.
struct Observer : Remembered {
  /// One line of the story, as the log has it too.
  virtual void told(OnboardTime when, std::string_view line) = 0;
  /// Every telemetry packet that is routed.
  virtual void routed(const pus::TelemetryView& /*packet*/) {}
  void note(OctetWriter& /*writer*/) const override {}
  void recall(OctetReader& /*reader*/) override {}
};

}  // namespace hirosco::supervisor
