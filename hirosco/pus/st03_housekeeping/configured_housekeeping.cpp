// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/configured_housekeeping.hpp"

namespace hirosco::pus {

Result<> ConfiguredHousekeeping::configure(const descriptor::Configuration& configuration) {
  sampler_ = std::make_unique<HousekeepingSampler>();
  service_ = std::make_unique<HousekeepingService>(subsystem_, *sampler_, verification_, sink_);
  HIROSCO_TRY(service_->load(subsystem_.housekeeping));
  return service_->load(configuration.housekeeping);
}

void ConfiguredHousekeeping::release() noexcept {
  service_.reset();
  sampler_.reset();
}

}  // namespace hirosco::pus
