// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "robotics/limits/two_of_three.hpp"
#include "subsystems/manipulator/control/joints.hpp"

/// What stops an arm by its own sensors.
namespace hirosco::manipulator {

enum class TorqueVerdict : std::uint8_t { Fine, Soft, Hard };

/// Trips when two of the last three samples of one joint exceed a limit: one disturbed sample does not stop a mission.
class TorqueLimit {
 public:
  void reset() noexcept { *this = {}; }
  /// The worst verdict of all joints; `joint` and `value` tell of which. NaN counts as above every limit.
  struct Finding {
    TorqueVerdict verdict{TorqueVerdict::Fine};
    std::uint8_t joint{0};
    double value_n_m{0};
  };
  [[nodiscard]] Finding update(const Joints& torque_n_m, double soft_n_m, double hard_n_m) noexcept;

 private:
  std::array<robotics::TwoOfThree, max_joints> soft_{};
  std::array<robotics::TwoOfThree, max_joints> hard_{};
};

/// Tells each limit once until it is armed anew; a higher one whatever a lower one did.
class TorqueGuard {
 public:
  enum class Watch : std::uint8_t { Both, HardOnly };
  void arm() noexcept { *this = {}; }
  /// What is to be told now, if anything.
  [[nodiscard]] std::optional<TorqueLimit::Finding> update(const Joints& torque_n_m, double soft_n_m, double hard_n_m,
                                                           Watch watch) noexcept;
  [[nodiscard]] bool tripped() const noexcept { return told_ != TorqueVerdict::Fine; }

 private:
  TorqueLimit limit_;
  TorqueVerdict told_{TorqueVerdict::Fine};
};

enum class TemperatureVerdict : std::uint8_t { Fine, Warning, Critical, Maximum };

struct TemperatureLimits {
  float warning_c{55};
  float critical_c{70};
  float maximum_c{80};
};
/// Verdict of the hottest joint; NaN counts as maximum.
[[nodiscard]] TemperatureVerdict judge(const Temperatures& temperature_c, const TemperatureLimits& limits) noexcept;

/// Tells each level once on the way up, and again on an entry into Operational that is too early; a level is left only
/// downwards.
class TemperatureGuard {
 public:
  enum class Moment : std::uint8_t { EntryIntoOperational, Other };
  struct Finding {
    TemperatureVerdict verdict{TemperatureVerdict::Fine};
    std::uint8_t joint{0};  ///< the hottest
    float value_c{0};
  };
  void reset() noexcept { *this = {}; }
  /// What is to be told now, if anything.
  [[nodiscard]] std::optional<Finding> update(const Temperatures& temperature_c, const TemperatureLimits& limits,
                                              Moment moment) noexcept;
  /// From the critical temperature on nothing is moved.
  [[nodiscard]] bool too_hot() const noexcept { return verdict_ >= TemperatureVerdict::Critical; }

 private:
  TemperatureVerdict verdict_{TemperatureVerdict::Fine};
};

}  // namespace hirosco::manipulator
