// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

/// Whether a temperature sensor is to be believed. No framework.  Realtime: wait-free.
namespace hirosco::thermal {

/// How many cycles in a row what is measured has to be wrong: one frame that is damaged makes no fault.
inline constexpr int in_a_row = 3;

struct SensorLimits {
  float low_c{-150}, high_c{150};  ///< no reading beyond is a temperature of the craft
  float rate_k_s{1};  ///< no zone gets warmer or colder faster
  float stuck_s{0};  ///< a reading that is the same to its last bit for as long; 0: never asked
};

/// Values of the enumeration SENSOR_STATES of thermal.xml.
enum class Doubt : std::uint8_t { None = 0, NoTemperature = 1, Jumped = 2, Stuck = 3 };

[[nodiscard]] inline bool is_temperature(float reading_c, const SensorLimits& limits) noexcept {
  return std::isfinite(reading_c) && reading_c >= limits.low_c && reading_c <= limits.high_c;
}

/// One sensor. Who is doubted stays so until somebody trusts it again.
class ZoneSensor {
 public:
  /// A reading, `dt_s` after the last one. The doubt that begins with it, once.
  Doubt update(float reading_c, float dt_s, const SensorLimits& limits) noexcept {
    since_s_ += dt_s;
    if (doubt_ != Doubt::None) return Doubt::None;
    const Doubt wrong = wrong_with(reading_c, limits);
    if (wrong == Doubt::None) {
      believe(reading_c, dt_s);
      return limits.stuck_s > 0 && same_s_ >= limits.stuck_s ? doubt_ = Doubt::Stuck : Doubt::None;
    }
    if (++wrong_in_a_row_ < in_a_row) return Doubt::None;
    return doubt_ = wrong;
  }
  /// Believed again from this reading on. False: it is no temperature, and nothing has changed.
  bool trust(float reading_c, const SensorLimits& limits) noexcept {
    if (!is_temperature(reading_c, limits)) return false;
    *this = {};
    believe(reading_c, 0);
    return true;
  }

  /// There is a temperature, and the sensor is believed.
  [[nodiscard]] bool good() const noexcept { return known_ && doubt_ == Doubt::None; }
  [[nodiscard]] Doubt doubt() const noexcept { return doubt_; }
  /// Last that was believed.
  [[nodiscard]] float temperature_c() const noexcept { return temperature_c_; }

 private:
  [[nodiscard]] Doubt wrong_with(float reading_c, const SensorLimits& limits) const noexcept {
    constexpr float of_a_sensor_k = 0.5F;  // its noise and its steps
    if (!is_temperature(reading_c, limits)) return Doubt::NoTemperature;
    const float most_k = limits.rate_k_s * since_s_ + of_a_sensor_k;
    return known_ && std::abs(reading_c - temperature_c_) > most_k ? Doubt::Jumped : Doubt::None;
  }
  void believe(float reading_c, float dt_s) noexcept {
    same_s_ = known_ && reading_c == temperature_c_ ? same_s_ + dt_s : 0;
    temperature_c_ = reading_c;
    known_ = true;
    wrong_in_a_row_ = 0;
    since_s_ = 0;
  }

  float temperature_c_{0};
  float since_s_{0};  ///< that `temperature_c_` was read
  float same_s_{0};
  int wrong_in_a_row_{0};
  Doubt doubt_{Doubt::None};
  bool known_{false};
};

}  // namespace hirosco::thermal
