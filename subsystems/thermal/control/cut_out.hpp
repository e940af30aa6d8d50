// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/thermal/control/zone_sensor.hpp"

/// What takes the line from a heater whose zone is too hot. It knows no law, no set point, no duty and no doubt: a reading and a limit.
namespace hirosco::thermal {

class CutOut {
 public:
  /// True when the line opens with this reading. What is no temperature says nothing; what the sensor's own check makes of it does not count.
  bool update(float reading_c, float hottest_c, const SensorLimits& limits) noexcept {
    if (open_) return false;
    hot_in_a_row_ = is_temperature(reading_c, limits) && reading_c > hottest_c ? hot_in_a_row_ + 1 : 0;
    return open_ = hot_in_a_row_ >= in_a_row;
  }
  /// By telecommand. False: it is as hot still.
  bool close(float reading_c, float hottest_c, const SensorLimits& limits) noexcept {
    if (is_temperature(reading_c, limits) && reading_c > hottest_c - cooled_k) return false;
    *this = {};
    return true;
  }
  [[nodiscard]] bool open() const noexcept { return open_; }

  /// Below its limit a zone has to be before its line is closed again.
  static constexpr float cooled_k = 5;

 private:
  int hot_in_a_row_{0};
  bool open_{false};
};

}  // namespace hirosco::thermal
