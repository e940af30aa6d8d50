// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::pus {

/// ST[03] of a subsystem: a new sampler and service for each configuration, to whose cycle its structures belong.
/// Thread: the service loop.
class ConfiguredHousekeeping final : public Service {
 public:
  /// `subsystem` outlives the service.
  ConfiguredHousekeeping(const descriptor::Subsystem& subsystem, Verification& verification, TelemetrySink& sink)
      : subsystem_{subsystem}, verification_{verification}, sink_{sink} {}
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return HousekeepingService::service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override {
    service_->handle(telecommand, request);
  }
  [[nodiscard]] bool in_force() const noexcept override { return service_ != nullptr; }
  [[nodiscard]] Result<> configure(const descriptor::Configuration& configuration) override;
  void release() noexcept override;
  /// The cycle's half; null while no configuration is in force.
  [[nodiscard]] HousekeepingSampler* sampler() noexcept { return sampler_.get(); }

 private:
  const descriptor::Subsystem& subsystem_;
  Verification& verification_;
  TelemetrySink& sink_;
  std::unique_ptr<HousekeepingSampler> sampler_;
  std::unique_ptr<HousekeepingService> service_;
};

}  // namespace hirosco::pus
