// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/manipulator/sensor_watch.hpp"
#include "subsystems/manipulator/setpoint.hpp"

namespace hirosco::manipulator {

/// An arm's self test (adr 0073): the sensors at rest, then what the law would put out for small deviations of each joint to each
/// side, up to the output itself. A law with a wrong sign would run away from where it is to hold.
/// Realtime: bounded, no allocation. Thread: the cycle.
class SelfCheck {
 public:
  struct Parts {
    const DescribedJoints& joints;
    Drives& drives;
    Servo& servo;
    Setpoint& setpoint;
    const SensorWatch& watch;
    const Parameters& parameters;
  };
  explicit SelfCheck(const Parts& parts) noexcept : parts_{parts} {}

  /// One deviation in each cycle: joints to both sides in turn. `cycle.first`: it begins anew.
  [[nodiscard]] Result<Step> step(const Cycle& cycle) noexcept;

 private:
  [[nodiscard]] Result<> check_sensors() const noexcept;
  [[nodiscard]] Result<> check_law(std::size_t joint, double side) noexcept;

  Parts parts_;
  std::size_t tried_{0};  ///< each joint to each side
};

}  // namespace hirosco::manipulator
