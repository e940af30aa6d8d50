// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/measured_budget.hpp"

#include <cmath>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::supervisor {

bool MeasuredBudget::hear(std::uint16_t from, const pus::TelemetryView& report, TimePoint now) noexcept {
  using Housekeeping = pus::HousekeepingService;
  if (from != declared_.apid || report.service() != Housekeeping::service_type ||
      report.subtype() != Housekeeping::parameter_report)
    return false;
  const Octets data = report.source_data();
  OctetReader reader{data};
  const auto structure = reader.get<std::uint16_t>();
  // Ground may have appended to it: where the value stands then, nobody has judged.
  if (!reader.good() || structure != declared_.at.structure || data.size() != declared_.at.octets) return false;
  OctetReader value{data.subspan(sizeof structure + declared_.at.offset)};
  watts_ = value.get<double>();
  heard_ = now;
  doubt_ = value.good() && std::isfinite(watts_) && watts_ >= 0 ? Doubt::None : Doubt::NoNumber;
  return true;
}

void MeasuredBudget::gone() noexcept {
  if (doubt_ != Doubt::NeverHeard) doubt_ = Doubt::Gone;
}

void MeasuredBudget::watch(TimePoint now) noexcept {
  if ((doubt_ == Doubt::None || doubt_ == Doubt::NoNumber) && now - heard_ > declared_.age) doubt_ = Doubt::Old;
}

}  // namespace hirosco::supervisor
