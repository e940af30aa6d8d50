// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/cycle/control_state.hpp"
#include "hirosco/subsystem/cycle/cycle_plan.hpp"
#include "hirosco/subsystem/cycle/permit_watch.hpp"
#include "hirosco/subsystem/cycle/reconfiguration.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"
#include "hirosco/subsystem/cycle/self_test_run.hpp"

namespace hirosco {

/// The one cycle in which another configuration is taken over without a break (docs/adr/0096), whole or not at all: it begins where commands
/// are taken and ends before anything is put out. What comes of it is reported. Thread: the cycle's.
class BumplessChange {
 public:
  struct Parts {
    Subsystem& author;
    const descriptor::SubsystemDescriptor& descriptor;
    Dictionary& dictionary;
    CyclePlan& plan;
    ControlState& control;
    const PermitWatch& permit;
    const SelfTestRun& self_test;
    ReportWriter& reports;
  };
  explicit BumplessChange(const Parts& parts) noexcept : parts_{parts} {}

  /// In the cycle that was due at `planned`. False: it was refused, and nothing has changed. True: values, law and plan are those of `wanted`; what
  /// is counted in cycles is its caller's to begin anew.  Realtime: bounded.
  [[nodiscard]] bool begin(Reconfiguration& wanted, TimePoint planned) noexcept;
  /// In each cycle, before anything is put out: in the one that took a configuration over, what jumps beyond its declared step reaches no
  /// actuator.  Realtime: bounded.
  void end() noexcept;

 private:
  [[nodiscard]] const char* why_not(const Reconfiguration& wanted) const noexcept;

  Parts parts_;
  const Reconfiguration* taken_over_{nullptr};  ///< in this cycle
};

}  // namespace hirosco
