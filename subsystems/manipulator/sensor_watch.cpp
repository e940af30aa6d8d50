// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/sensor_watch.hpp"

namespace hirosco::manipulator {

void SensorWatch::reset() noexcept {
  torque_guard_.arm();
  temperature_guard_.reset();
}

std::optional<SensorWatch::Overload> SensorWatch::loads(TorqueGuard::Watch watch) noexcept {
  const double soft = parts_.parameters.torque_limit.load();
  const double hard = parts_.parameters.torque_hard.load();
  const auto finding = torque_guard_.update(parts_.drives.sensed().torque_n_m, soft, hard, watch);
  if (!finding) return std::nullopt;
  const bool is_hard = finding->verdict == TorqueVerdict::Hard;
  return Overload{is_hard ? torque_hard_exceeded_ : torque_limit_exceeded_,
                  static_cast<std::uint8_t>(finding->joint + 1), finding->value_n_m, is_hard ? hard : soft};
}

std::optional<SensorWatch::Heat> SensorWatch::temperatures(TemperatureGuard::Moment moment) noexcept {
  const auto limits = parts_.parameters.temperature_limits.load();
  const auto finding =
      temperature_guard_.update(parts_.drives.sensed().temperature_deg_c, {limits[0], limits[1], limits[2]}, moment);
  if (!finding) return std::nullopt;
  const auto& event = finding->verdict == TemperatureVerdict::Warning    ? temperature_warning_
                      : finding->verdict == TemperatureVerdict::Critical ? temperature_critical_
                                                                         : temperature_maximum_;
  return Heat{event, static_cast<std::uint8_t>(finding->joint + 1), static_cast<float>(finding->value_c)};
}

pus::FailureCode SensorWatch::why_stopped() const noexcept {
  if (torque_guard_.tripped()) return static_cast<pus::FailureCode>(Trouble::torque_tripped);
  if (temperature_guard_.too_hot()) return static_cast<pus::FailureCode>(Trouble::too_hot);
  return pus::FailureCode::Aborted;
}

}  // namespace hirosco::manipulator
