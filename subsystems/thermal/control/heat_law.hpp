// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

/// How long a heater is to be on, as a share of the time. No framework.  Realtime: wait-free.
namespace hirosco::thermal {

/// Values of the enumeration LAWS of thermal.xml.
enum class LawKind : std::uint8_t { Thermostat = 0, Proportional = 1 };

struct LawValues {
  float gain_per_k{0.2F};  ///< share for each K that is lacking
  float reset_s{3000};  ///< in which the integral adds what the gain does at once
  float hysteresis_k{
      2};  ///< of the thermostat: on below the middle less half of it, off above the middle and half of it
};

/// Of one zone. What it remembers is a share from 0 to 1 in either kind, so each begins where the other ended.
class HeatLaw {
 public:
  /// Whether all that was wanted lately was also given: an integral that grows while it was not would never come down.
  enum class Given : std::uint8_t { All, Less };

  [[nodiscard]] float thermostat(float lacking_k, const LawValues& values) noexcept {
    if (lacking_k > values.hysteresis_k / 2) held_ = 1;
    if (lacking_k < -values.hysteresis_k / 2) held_ = 0;
    return held_ = held_ > 0.5F ? 1.0F : 0.0F;
  }
  [[nodiscard]] float proportional(float lacking_k, float dt_s, Given given, const LawValues& values) noexcept {
    const float by_gain = values.gain_per_k * lacking_k;
    const float wanted = by_gain + held_;
    const bool no_more = wanted > 1 || given == Given::Less;
    if (!(no_more && lacking_k > 0) && !(wanted < 0 && lacking_k < 0)) held_ += by_gain * dt_s / values.reset_s;
    held_ = std::clamp(held_, 0.0F, 1.0F);
    return std::clamp(by_gain + held_, 0.0F, 1.0F);
  }
  void begin(float share) noexcept { held_ = share; }

 private:
  float held_{0};
};

}  // namespace hirosco::thermal
