// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::supervisor {

/// What a subsystem measures of the craft's electrical power, as far as it is to be believed (docs/adr/0124): a number that is not negative,
/// from a report of the declared form, no older than the mission permits, of somebody who runs. Everything else is no measurement.
/// Thread: the supervisor's.
class MeasuredBudget {
 public:
  /// Why it is not known.
  enum class Doubt : std::uint8_t {
    None,
    NeverHeard,
    Old,
    Gone,  ///< who measures does not run
    NoNumber,  ///< who measures says that it does not know
  };

  explicit MeasuredBudget(const descriptor::MeasuredPower& declared) noexcept : declared_{declared} {}

  /// True: this report tells it.
  bool hear(std::uint16_t from, const pus::TelemetryView& report, TimePoint now) noexcept;
  /// Who measures does not run.
  void gone() noexcept;
  void watch(TimePoint now) noexcept;

  [[nodiscard]] Doubt doubt() const noexcept { return doubt_; }
  /// Empty: not known.
  [[nodiscard]] std::optional<double> watts() const noexcept {
    return doubt_ == Doubt::None ? std::optional{watts_} : std::nullopt;
  }

 private:
  descriptor::MeasuredPower declared_;
  Doubt doubt_{Doubt::NeverHeard};
  double watts_{0};
  TimePoint heard_{};
};

}  // namespace hirosco::supervisor
