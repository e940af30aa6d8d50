// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/robot_arm/control/sample_time.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"

namespace hirosco::robot_arm {

/// The drives of an arm's joints, on whatever base, with their sensors: what the device says, and what it is to do.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Drives {
 public:
  /// `current` tells what is measured.
  explicit Drives(Parameter<CurrentValues>& current) noexcept : current_{current} {}

  /// Before port(): the device tells force and moment at the tip, too.
  void take_force() noexcept { tells_force_ = true; }
  [[nodiscard]] bool tells_force() const noexcept { return tells_force_; }
  /// Before port(): the device tells which joints know their zero, too, and takes it where it is told to (docs/adr/0208).
  void take_references() noexcept { tells_references_ = true; }
  [[nodiscard]] bool tells_references() const noexcept { return tells_references_; }
  /// For use_device().
  [[nodiscard]] DevicePortBase& port() noexcept {
    return with_port(*this, [](auto& port) -> DevicePortBase& { return port; });
  }
  [[nodiscard]] bool alive() const noexcept {
    return with_port(*this, [](const auto& port) { return port.alive(); });
  }

  /// As if so many joints stood at 0.
  void forget(std::size_t joints) noexcept;
  /// Takes what the device last said, and tells it.
  void measure(const Cycle& cycle) noexcept;
  /// When that was measured.
  [[nodiscard]] const SampleTime& sample_time() const noexcept { return sample_time_; }
  /// Of no length before there is any.
  [[nodiscard]] const Measured& measured() const noexcept { return measured_; }
  /// What the device last said, of the lengths that its descriptor has.
  [[nodiscard]] ArmInput says() const noexcept;
  /// Of a device that tells it.
  [[nodiscard]] TipForce force() const noexcept;

  /// Likewise: 1 where POSITION is from the joint's zero.
  [[nodiscard]] JointFlags references() const noexcept;
  /// Whose device tells nothing of it is always.
  [[nodiscard]] bool referenced(std::size_t joint) const noexcept;
  /// The first that is not.
  [[nodiscard]] std::optional<std::size_t> not_referenced(std::size_t joints) const noexcept;

  /// N m or N, from this cycle on.
  void put_out(const Joints& torque) noexcept {
    with_port(*this, [&](auto& port) { port.output().torque = torque; });
  }
  [[nodiscard]] const Joints& puts_out() noexcept {
    return with_port(*this, [](auto& port) -> const Joints& { return port.output().torque; });
  }
  /// Which joints take their zero at their marks, from this cycle on; of a device that does.
  void take_zero(const JointFlags& joints) noexcept;
  /// Of how many joints it may be told so.
  [[nodiscard]] std::size_t takes_zeros() noexcept;

 private:
  /// That of the fields which the device has.
  template <class Self, class Do>
  static auto with_port(Self& self, const Do& what) -> decltype(what(self.port_)) {
    if (self.tells_references_) {
      if (self.tells_force_) return what(self.sensing_referenced_port_);
      return what(self.referenced_port_);
    }
    if (self.tells_force_) return what(self.sensing_port_);
    return what(self.port_);
  }

  Parameter<CurrentValues>& current_;
  DevicePort<ArmInput, ArmOutput> port_;
  // In its place, where the device has more.
  DevicePort<SensingArmInput, ArmOutput> sensing_port_;
  DevicePort<ReferencedArmInput, ReferencedArmOutput> referenced_port_;
  DevicePort<SensingReferencedArmInput, ReferencedArmOutput> sensing_referenced_port_;
  bool tells_force_{false};
  bool tells_references_{false};
  Measured measured_;
  SampleTime sample_time_;
};

}  // namespace hirosco::robot_arm
