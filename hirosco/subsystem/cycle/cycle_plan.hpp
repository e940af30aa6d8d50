// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/subsystem/cycle/device_slot.hpp"
#include "hirosco/subsystem/cycle/link_slots.hpp"

namespace hirosco {

/// What of a configuration the cycle works on. Built by the service loop while the cycle rests.
struct CyclePlan {
  const descriptor::Configuration* configuration{nullptr};
  std::vector<LinkInputSlot> inputs;
  std::vector<LinkOutputSlot> outputs;
  std::vector<DeviceSlot> devices;
  pus::HousekeepingSampler* sampler{nullptr};
  std::vector<std::uint16_t> device_lost_events;  ///< ids, per device
  std::vector<std::uint16_t> fell_back_events;  ///< ids, per device
  std::vector<std::uint16_t> input_stale_events;  ///< per input
};

}  // namespace hirosco
