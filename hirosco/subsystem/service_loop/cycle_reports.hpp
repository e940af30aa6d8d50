// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/service_loop/bumpless.hpp"
#include "hirosco/subsystem/service_loop/link_ends.hpp"
#include "hirosco/subsystem/service_loop/open_calls.hpp"
#include "hirosco/subsystem/service_loop/reports.hpp"
#include "hirosco/subsystem/service_loop/self_tests.hpp"

namespace hirosco {

class StateMachine;

/// Takes what the cycle says and tells whom it concerns.  Thread: the service loop.
class CycleReports {
 public:
  struct Parts {
    LoopRings& rings;
    Reports& reports;
    OpenCalls& calls;
    StateMachine& states;
    LinkEnds& links;
    Bumpless& bumpless;
    SelfTests& self_tests;
  };
  explicit CycleReports(const Parts& parts) : parts_{parts} {}

  /// Answers and events in the order in which the cycle made them, housekeeping behind.
  void take();

 private:
  void take_one(const CycleReport& head, Octets payload);

  Parts parts_;
};

}  // namespace hirosco
