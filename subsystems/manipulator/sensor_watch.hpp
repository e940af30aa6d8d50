// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/subsystem/author/event_port.hpp"
#include "subsystems/manipulator/control/sensor_limits.hpp"
#include "subsystems/manipulator/drives.hpp"
#include "subsystems/manipulator/trouble.hpp"

namespace hirosco::manipulator {

/// Loads and temperatures of the joints against the limits that parameters say: what is told of them, and what stops the arm. It reports
/// nothing and inhibits nothing itself.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class SensorWatch {
 public:
  struct Parts {
    const Drives& drives;
    const Parameters& parameters;
  };
  /// To be raised with these.
  struct Overload {
    const Event<std::uint8_t, double, double>& event;
    std::uint8_t joint;  ///< from 1
    double value_n_m;
    double limit_n_m;
  };
  struct Heat {
    const Event<std::uint8_t, float>& event;
    std::uint8_t joint;  ///< from 1
    float value_c;
  };
  explicit SensorWatch(const Parts& parts) noexcept : parts_{parts} {}
  /// What it found refers to its events.
  SensorWatch(const SensorWatch&) = delete;
  SensorWatch& operator=(const SensorWatch&) = delete;

  /// Calls `use(event)` for each that it may find.
  template <class Use>
  void each_event(const Use& use) {
    use(temperature_warning_);
    use(temperature_critical_);
    use(temperature_maximum_);
    use(torque_limit_exceeded_);
    use(torque_hard_exceeded_);
  }

  /// Nothing was found yet.
  void reset() noexcept;
  /// An entry into Operational: limits of torque are told anew.
  void arm() noexcept { torque_guard_.arm(); }
  /// Each limit is told once until it is armed anew; a higher one whatever a lower one did. What is found stops the arm.
  [[nodiscard]] std::optional<Overload> loads(TorqueGuard::Watch watch) noexcept;
  /// What is found is told; too_hot() stops the arm.
  [[nodiscard]] std::optional<Heat> temperatures(TemperatureGuard::Moment moment) noexcept;

  /// By a torque.
  [[nodiscard]] bool tripped() const noexcept { return torque_guard_.tripped(); }
  [[nodiscard]] bool too_hot() const noexcept { return temperature_guard_.too_hot(); }
  /// What a function that runs is told when the actuators were taken away from it.
  [[nodiscard]] pus::FailureCode why_stopped() const noexcept;

 private:
  Parts parts_;
  Event<std::uint8_t, float> temperature_warning_{"TEMPERATURE_WARNING"};  // joint from 1, degC
  Event<std::uint8_t, float> temperature_critical_{"TEMPERATURE_CRITICAL"};
  Event<std::uint8_t, float> temperature_maximum_{"TEMPERATURE_MAXIMUM"};
  Event<std::uint8_t, double, double> torque_limit_exceeded_{"TORQUE_LIMIT_EXCEEDED"};  // joint from 1, N m, limit
  Event<std::uint8_t, double, double> torque_hard_exceeded_{"TORQUE_HARD_EXCEEDED"};
  TorqueGuard torque_guard_;
  TemperatureGuard temperature_guard_;
};

}  // namespace hirosco::manipulator
