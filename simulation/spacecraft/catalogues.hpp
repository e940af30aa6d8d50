// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "hirosco/subsystem/author/module.hpp"
#include "simulation/devices/simulated_device.hpp"

/// Who makes what flies in a simulated spacecraft, by the names of the mission's executables.
namespace hirosco::simulation {

/// Makes the author's object of an executable of the mission: as its module tells, or as a callable does that takes nothing.
struct SubsystemMaker {
  static constexpr const char* no_ground_link =
      "it cannot hold a simulated ground link: its module has no maker on a transport that is given "
      "(subsystem_module<make, make_on_transport>)";

  SubsystemMaker() = default;
  SubsystemMaker(const SubsystemModule& module) : make{module.make}, make_on_transport{module.make_on_transport} {}
  template <std::invocable Make>
  SubsystemMaker(Make maker) : make{std::move(maker)} {}

  std::function<std::unique_ptr<Subsystem>()> make;
  /// Of what can hold the mission's ground link: here it is made on the simulated ground.
  std::function<std::unique_ptr<Subsystem>(OpenGroundTransport)> make_on_transport;
};
/// Another version of one stands there as NAME@VERSION, as in a manifest (docs/adr/0089).
using SubsystemCatalogue = std::map<std::string, SubsystemMaker, std::less<>>;
/// Makes the simulated device of an executable, at the device's side of an endnode.
using MakeDevice =
    std::function<std::unique_ptr<SimulatedDevice>(FlowFactory&, const FlowAddress&, const SimulatedDevice::Settings&)>;
using DeviceCatalogue = std::map<std::string, MakeDevice, std::less<>>;

}  // namespace hirosco::simulation
