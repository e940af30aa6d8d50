// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "simulation/devices/module.hpp"
#include "simulation/mujoco/base_device.hpp"
#include "simulation/mujoco/mujoco_device.hpp"
#include "simulation/mujoco/part_device.hpp"

namespace {

using namespace hirosco::simulation;

constexpr std::array base_lines{
    FaultLine{"attitude_noise 0.003", "the star tracker of a base that floats, standard deviation in degrees"},
    FaultLine{"position_noise 0.001", "how exactly that base knows its place, standard deviation in m"},
    FaultLine{"stuck on",
              "that base goes on telling the place and attitude that it told last, as if new; off: it measures again"},
};
constexpr auto lines = [] {
  std::array<FaultLine, MujocoDevice::fault_lines.size() + base_lines.size()> all{};
  std::ranges::copy(MujocoDevice::fault_lines, all.begin());
  std::ranges::copy(base_lines, all.begin() + MujocoDevice::fault_lines.size());
  return all;
}();

/// Joints have a world. Who is in one is its base, which has endnodes by their names, or some of its joints, which have one.
std::unique_ptr<SimulatedDevice> make(hirosco::FlowFactory& flows, const hirosco::FlowAddress& address,
                                      const SimulatedDevice::Settings& settings) {
  if (settings.in_world_of == nullptr) return make_device<MujocoDevice>(flows, address, settings);
  if (settings.endnode.empty()) return make_device<PartDevice>(flows, address, settings);
  return make_device<BaseDevice>(flows, address, settings);
}

constexpr DeviceModule content{make, lines};
constexpr hirosco::Module module{.kind = hirosco::ModuleKind::SimulatedDevice, .content = &content};

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &module; }
