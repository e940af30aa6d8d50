// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>

#include "hirosco/pus/st03_housekeeping/configured_housekeeping.hpp"
#include "hirosco/subsystem/cycle/cycle.hpp"
#include "hirosco/subsystem/cycle/reconfiguration.hpp"
#include "hirosco/subsystem/service_loop/own_loops.hpp"
#include "hirosco/subsystem/service_loop/parameter_values.hpp"
#include "hirosco/subsystem/service_loop/permit_pages.hpp"
#include "hirosco/subsystem/service_loop/platform.hpp"
#include "hirosco/subsystem/service_loop/reports.hpp"
#include "hirosco/subsystem/service_loop/self_tests.hpp"
#include "hirosco/subsystem/service_loop/situation.hpp"

namespace hirosco {

/// CONFIGURE while the subsystem acts, between configurations that its descriptor declares compatible (docs/adr/0096).
/// Thread: the service loop.
class Bumpless {
 public:
  struct Parts {
    const descriptor::SubsystemDescriptor& descriptor;
    const Platform& platform;
    Situation& at;
    ParameterValues& values;
    CycleLoop& cycle;
    LoopRings& rings;
    const VitalPage& vital;
    const PermitPages& permit;
    OwnLoops& loops;
    pus::ConfiguredHousekeeping& housekeeping;
    SelfTests& self_tests;
    Reports& reports;
  };
  explicit Bumpless(const Parts& parts) : parts_{parts} {}

  /// A notice: refused, nothing was begun. Else it has begun and ends by its own report, of a failure, too, and perhaps at once.
  std::expected<void, pus::FailureNotice> command(const descriptor::Configuration& wanted, const pus::Request& request);
  /// One is on its way to the cycle, which has not said how it took it.
  [[nodiscard]] bool under_way() const noexcept { return change_ != nullptr; }
  /// How the cycle has taken it.
  void ended(std::uint8_t id, const std::optional<Failure>& why);
  /// A cycle that hangs confirms nothing: the request ends all the same, and the next command is heard.
  void step(TimePoint now);
  void give_up(pus::FailureCode code);
  /// The cycle rests.
  void release() noexcept { hold(nullptr); }

 private:
  void hold(std::unique_ptr<Reconfiguration> change) noexcept;

  Parts parts_;
  /// On its way to the cycle, or taken by one that has not said so; nobody waits for it any more without a request.
  std::unique_ptr<Reconfiguration> change_;
  std::optional<pus::Request> request_;
  TimePoint deadline_{};
};

}  // namespace hirosco
