// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/sample_time.hpp"

namespace hirosco::robot_arm {

/// What acts on the joints from outside, without measuring an acceleration: the generalised momentum changes by what the model knows
/// (drives, gravity, velocities) and by what it does not know, which is told here behind a filter of first order. What is wrong in
/// the model is told, too. It goes by the time that has passed between samples, whatever was missed in it (docs/adr/0229).
class MomentumObserver {
 public:
  /// `gain_per_s`: 1 / time constant of the filter.
  MomentumObserver(int joints, double cycle_s, double gain_per_s) noexcept;
  void reset() noexcept;
  /// A new sample. `dynamics` was updated with it, gravity included; `payload_torque`: what the payload takes without accelerating; `between`: since the sample before, more
  /// than nothing; left out: a cycle.
  void update(const Measured& measured, robotics::Dynamics& dynamics, const robotics::Coordinates& payload_torque,
              std::optional<SampleTime::Between> between = {}) noexcept;
  /// Likewise by the inertia that the joints feel, and what they take without accelerating, besides a payload: of an arm whose base gives way.
  void update(const Measured& measured, const robotics::MassMatrix& mass, const robotics::Coordinates& bias,
              const robotics::Coordinates& payload_torque, std::optional<SampleTime::Between> between = {}) noexcept;
  /// N m or N, in the direction in which it would accelerate the joints.
  [[nodiscard]] const JointVector& external() const noexcept { return external_; }
  /// What the last update() has left of what was told before, as a share of it.
  [[nodiscard]] double kept() const noexcept { return kept_; }

 private:
  /// A sample as it goes into the balance.
  struct Sample {
    JointVector momentum;
    JointVector velocity;
    JointVector torque;
    JointVector taken;  ///< of it, without accelerating
    robotics::MassMatrix mass;
  };
  /// One of which nobody knows when it was measured.
  struct PassedOver {
    JointVector torque;
    double earliest_s{0};  ///< since the newest one that was taken
  };
  static constexpr std::size_t most_passed_over = 3;

  void begin_with(const Sample& now) noexcept;
  void begin_anew(const Sample& now) noexcept;
  void take_cycle(const Sample& now) noexcept;
  void take_longer(const Sample& now, double passed_s) noexcept;
  void find_times(const JointVector& torque, double whole_s, JointVector& acted) const noexcept;

  double cycle_s_;
  double gain_per_s_;
  double kept_of_cycle_;
  double kept_{1};
  bool started_{false};
  Sample before_;  ///< the newest one that was taken
  double passed_s_{0};  ///< since then, of samples that were passed over
  std::array<PassedOver, most_passed_over> passed_over_;
  std::size_t passed_over_count_{0};
  bool began_anew_{false};  ///< with the newest one
  JointVector begun_;  ///< momentum at reset()
  JointVector known_;  ///< what came to it since, the estimate included
  JointVector external_;
};

}  // namespace hirosco::robot_arm
