// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/force_sensor.hpp"
#include "subsystems/robot_arm/joint_contact.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// What acts from outside on the joints of a craft that floats, and whether it is a contact (docs/adr/0222): the observer and the judgement of the arm that stands, with the inertia that joints feel
/// while the base gives way. What acts on the base alone it feels as little as joints move the base.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class FloatingContact {
 public:
  /// Of the filter of what acts from outside.
  static constexpr double observer_gain_per_s = 50;

  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    FloatingCraft& craft;
    ForceSensor& wrist;  ///< counts anew as joints do
    FloatingParameters& parameters;  ///< EXTERNAL_TORQUE tells what it finds
  };
  explicit FloatingContact(const Parts& parts) noexcept : parts_{parts} {}

  /// The descriptor has SET_CONTACT: without it nobody is met.
  void offer() noexcept { offered_ = feels_ = true; }
  /// Somebody else wants to know what acts on the joints. Without either nothing is felt.
  void feel() noexcept { feels_ = true; }
  /// N m or N of each joint; 0 while brakes have them.
  [[nodiscard]] const JointVector& external() const noexcept { return observer_->external(); }
  /// In configure().  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);
  /// Each cycle, behind the craft's. `driven`: drives have the joints; what brakes hold is nobody's push.
  void update(bool driven) noexcept;
  /// Something else is at the tip: what acts from outside is felt anew.
  void forget() noexcept;

  /// Whoever is met from now on is told, whatever was told before.
  void arm(JointContact::Before load) noexcept;
  /// It was led to where links would meet, and stands: however hard he pushes, it floats no more for that, until arm().
  void stand_apart() noexcept;
  /// Each cycle in which the arm is driven: what it met, once for each time; nothing mostly.
  [[nodiscard]] std::optional<JointContact::Contact> meet() noexcept;
  /// Of who was met, by joints (false) or by the sensor at the wrist: he is to be answered, and is not whom the other one has told of just before.
  [[nodiscard]] bool is_another(bool at_wrist) noexcept;
  /// To whatever is met now.
  [[nodiscard]] JointContact::Reaction reaction() const noexcept;
  /// SET_CONTACT: counts anew.
  void set(std::uint8_t reaction, double limit) noexcept;

 private:
  Parts parts_;
  std::optional<MomentumObserver> observer_;
  JointContact felt_;
  bool offered_{false}, feels_{false};
  bool stands_apart_{false};
  std::uint32_t since_answered_{0};  ///< cycles, of the last one
  bool felt_at_wrist_{false};  ///< that one, first
};

}  // namespace hirosco::robot_arm
