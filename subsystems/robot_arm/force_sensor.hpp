// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// The sensor of force and moment at the tip of an arm, on whatever base, whose device tells them (docs/adr/0179): a measure of contact beside what the joints feel,
/// as long as it tells something. What PAYLOAD weighs is taken out; what it takes to accelerate it is not.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class ForceSensor {
 public:
  struct Parts {
    const Drives& drives;
    const Parameter<ContactValues>& contact;  ///< REACTION, LIMIT
  };
  /// What hangs there, as the arm stands.
  struct Hanging {
    robotics::Matrix3 tip;  ///< its axes
    Vector3 lever_m{Vector3::Zero()};  ///< from its origin to what hangs
    Vector3 weight_n{Vector3::Zero()};
  };
  /// What it felt, beyond what stood there when a motion began.
  struct Contact {
    double force_n{0};
    double moment_n_m{0};
  };
  explicit ForceSensor(const Parts& parts) noexcept : parts_{parts} {}

  /// Whether the device of the descriptor tells FORCE.
  [[nodiscard]] static bool declared(const descriptor::SubsystemDescriptor& subsystem);
  /// Calls `publish(name, cell)` for each parameter of it.
  template <class Publish>
  void each(const Publish& publish) {
    publish("WRIST", told_);
    publish("WRIST_RANGE", range_);
  }

  /// What acts on it counts from now on, whatever was felt before; where `stands`, a motion begins with it: up to the limit of it is borne, and what
  /// comes to that counts.
  void arm(bool stands) noexcept;
  /// Each cycle, behind the model: tells WRIST. It has just been lost: how old what it told last is, ms.
  [[nodiscard]] std::optional<std::uint32_t> update(const Hanging& hanging) noexcept;
  /// Each cycle in which the arm is driven: what it met, once for each time. Who `floats` meets nobody.
  [[nodiscard]] std::optional<Contact> meet(bool floats) noexcept;

 private:
  Parts parts_;
  Parameter<WristValues> told_;
  Parameter<WristRange> range_;
  bool valid_{false};
  bool was_valid_{false};
  Vector3 force_{Vector3::Zero()},
      moment_{Vector3::Zero()};  ///< from outside, about the tip's origin, in the axes in which the tip's are told
  Vector3 borne_force_{Vector3::Zero()}, borne_moment_{Vector3::Zero()};
  std::uint32_t contact_cycles_{0};
};

}  // namespace hirosco::robot_arm
