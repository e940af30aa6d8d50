// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/configured_housekeeping.hpp"

#include "hirosco/pus/st01_verification/verification.hpp"

namespace hirosco::pus {

void ConfiguredHousekeeping::handle(const TelecommandView& telecommand, const Request& request) {
  // What it would change is about to be replaced.
  if (next_) return verification_.rejected(request, FailureNotice{FailureCode::Busy});
  current_.service->handle(telecommand, request);
}

Result<ConfiguredHousekeeping::Halves> ConfiguredHousekeeping::make(const descriptor::Configuration& configuration) {
  Halves halves;
  halves.sampler = std::make_unique<HousekeepingSampler>();
  halves.service = std::make_unique<HousekeepingService>(subsystem_, *halves.sampler, verification_, sink_);
  HIROSCO_TRY(halves.service->load(subsystem_.housekeeping));
  HIROSCO_TRY(halves.service->load(configuration.housekeeping));
  return halves;
}

Result<> ConfiguredHousekeeping::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY_LET(current_, make(configuration));
  return ok();
}

Result<> ConfiguredHousekeeping::prepare(const descriptor::Configuration& configuration) {
  HIROSCO_TRY_LET(next_.emplace(), make(configuration));
  return ok();
}

void ConfiguredHousekeeping::take_prepared() noexcept {
  if (!next_) return;
  current_ = std::move(*next_);
  next_.reset();
}

void ConfiguredHousekeeping::release() noexcept {
  next_.reset();
  current_ = {};
}

}  // namespace hirosco::pus
