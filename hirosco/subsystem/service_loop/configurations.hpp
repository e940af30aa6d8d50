// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <vector>

#include "hirosco/pus/service/service_table.hpp"
#include "hirosco/subsystem/service_loop/bumpless.hpp"
#include "hirosco/subsystem/service_loop/introduced_ports.hpp"
#include "hirosco/subsystem/service_loop/link_ends.hpp"
#include "hirosco/subsystem/service_loop/open_calls.hpp"

namespace hirosco {

/// Puts a configuration in force in Pre-Operational, and gives it back: devices, links, parameters, services and the cycle's plan.
/// Thread: the service loop.
class Configurations {
 public:
  struct Parts {
    Subsystem& author;
    const descriptor::SubsystemDescriptor& descriptor;
    const Platform& platform;
    Situation& at;
    ParameterValues& values;
    CycleLoop& cycle;
    LoopRings& rings;
    CycleOrders& orders;
    VitalPage& vital;
    ResourceMeter& resources;
    IntroducedPorts& ports;
    LinkEnds& links;
    OwnLoops& loops;
    const pus::ServiceTable& services;
    pus::ConfiguredHousekeeping& housekeeping;
    SelfTests& self_tests;
    OpenCalls& calls;
    Bumpless& bumpless;
    Reports& reports;
  };
  explicit Configurations(const Parts& parts) : parts_{parts} {}

  /// A notice: refused, nothing was begun. Else it has begun and ends by its own report, of a failure, too, and perhaps at once.
  std::expected<void, pus::FailureNotice> command(std::uint8_t id, const pus::Request& request);
  /// What the service loop holds of it: links are told as gone, calls get their final report. The cycle may still use it.
  void end();
  /// Gives back all of it. The cycle rests: nothing of it is in use.
  void release();

 private:
  [[nodiscard]] std::optional<Failure> apply(const descriptor::Configuration& configuration);
  void plan_links(const descriptor::Configuration& configuration, CyclePlan& plan);
  [[nodiscard]] std::optional<Failure> plan_devices(const descriptor::Configuration& configuration, CyclePlan& plan);
  [[nodiscard]] Result<std::vector<DeviceSlot::Way>> open_ways(const descriptor::DeviceUse& use,
                                                               const DevicePortBase& port);

  Parts parts_;
};

}  // namespace hirosco
