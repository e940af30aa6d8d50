// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::pus {

/// ST[03] of a subsystem: a new sampler and service for each configuration, to whose cycle its structures belong.
/// Thread: its loop's; what puts a configuration in force is ordered with that (docs/adr/0096).
class ConfiguredHousekeeping final : public Service {
 public:
  /// `subsystem` outlives the service.
  ConfiguredHousekeeping(const descriptor::SubsystemDescriptor& subsystem, Verification& verification,
                         TelemetrySink& sink)
      : subsystem_{subsystem}, verification_{verification}, sink_{sink} {}
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return HousekeepingService::service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;
  [[nodiscard]] bool in_force() const noexcept override { return current_.service != nullptr; }
  [[nodiscard]] Result<> configure(const descriptor::Configuration& configuration) override;
  void release() noexcept override;
  /// The cycle's half; null while no configuration is in force.
  [[nodiscard]] HousekeepingSampler* sampler() noexcept { return current_.sampler.get(); }

  // --- a configuration that follows the one in force without a break ----------------------------------------------------
  /// Makes its halves beside those in force; requests are refused as busy until it is taken or dropped.
  [[nodiscard]] Result<> prepare(const descriptor::Configuration& configuration);
  /// The same of one that does not offer the service.
  void prepare_nothing() { next_.emplace(); }
  /// Null: nothing will be reported.
  [[nodiscard]] HousekeepingSampler* prepared_sampler() noexcept { return next_ ? next_->sampler.get() : nullptr; }
  /// The cycle uses the prepared half, and the one before no more.
  void take_prepared() noexcept;
  void drop_prepared() noexcept { next_.reset(); }

 private:
  struct Halves {
    std::unique_ptr<HousekeepingSampler> sampler;
    std::unique_ptr<HousekeepingService> service;
  };
  [[nodiscard]] Result<Halves> make(const descriptor::Configuration& configuration);

  const descriptor::SubsystemDescriptor& subsystem_;
  Verification& verification_;
  TelemetrySink& sink_;
  Halves current_;
  std::optional<Halves> next_;
};

}  // namespace hirosco::pus
