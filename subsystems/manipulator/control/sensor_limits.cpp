// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/sensor_limits.hpp"

namespace hirosco::manipulator {

TorqueLimit::Finding TorqueLimit::update(const Joints& torque_n_m, double soft_n_m, double hard_n_m) noexcept {
  Finding worst;
  for (std::size_t i = 0; i < torque_n_m.size(); ++i) {
    const double size = std::abs(torque_n_m[i]);
    const bool soft = soft_[i].add(!(size <= soft_n_m));
    const bool hard = hard_[i].add(!(size <= hard_n_m));
    const auto verdict = hard ? TorqueVerdict::Hard : soft ? TorqueVerdict::Soft : TorqueVerdict::Fine;
    if (verdict > worst.verdict) worst = {verdict, static_cast<std::uint8_t>(i), torque_n_m[i]};
  }
  return worst;
}

std::optional<TorqueLimit::Finding> TorqueGuard::update(const Joints& torque_n_m, double soft_n_m, double hard_n_m,
                                                        Watch watch) noexcept {
  const auto finding = limit_.update(torque_n_m, soft_n_m, hard_n_m);
  if (finding.verdict <= told_) return std::nullopt;
  if (watch == Watch::HardOnly && finding.verdict != TorqueVerdict::Hard) return std::nullopt;
  told_ = finding.verdict;
  return finding;
}

TemperatureVerdict judge(const Temperatures& temperature_c, const TemperatureLimits& limits) noexcept {
  TemperatureVerdict worst = TemperatureVerdict::Fine;
  for (const float celsius : temperature_c) {
    TemperatureVerdict verdict = TemperatureVerdict::Fine;
    if (!(celsius < limits.maximum_c)) verdict = TemperatureVerdict::Maximum;
    else if (celsius >= limits.critical_c) verdict = TemperatureVerdict::Critical;
    else if (celsius >= limits.warning_c) verdict = TemperatureVerdict::Warning;
    worst = std::max(worst, verdict);
  }
  return worst;
}

std::optional<TemperatureGuard::Finding> TemperatureGuard::update(const Temperatures& temperature_c,
                                                                  const TemperatureLimits& limits,
                                                                  Moment moment) noexcept {
  const TemperatureVerdict before = verdict_;
  verdict_ = judge(temperature_c, limits);
  const bool too_early = moment == Moment::EntryIntoOperational && too_hot();
  if (verdict_ <= before && !too_early) return std::nullopt;
  std::size_t hottest = 0;
  for (std::size_t i = 1; i < temperature_c.size(); ++i)
    if (temperature_c[i] > temperature_c[hottest]) hottest = i;
  return Finding{verdict_, static_cast<std::uint8_t>(hottest), temperature_c[hottest]};
}

}  // namespace hirosco::manipulator
