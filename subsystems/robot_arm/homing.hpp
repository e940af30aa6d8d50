// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/control/home_search.hpp"
#include "subsystems/robot_arm/control/homing_law.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/torque_control.hpp"
#include "subsystems/robot_arm/trouble.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// An arm whose joints do not know their zero when they are switched on (docs/adr/0208): in a configuration that homes it is held without its posture, and finds
/// their marks; in every other one it may not act before. An arm whose device tells nothing of it knows all its zeros.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class Homing {
 public:
  /// Of the device, in a configuration that homes: `on`.
  static constexpr std::string_view setting = "HOMING";

  struct Parts {
    const UrdfArm& known;
    Drives& drives;
    const TorqueControl& control;  ///< for the bandwidth in force
    Parameters& parameters;  ///< GRAVITY, ROTOR_INERTIA; DES_POSITION, DES_VELOCITY, BANDWIDTH_IN_FORCE tell of it
  };
  /// Why an arm may not act.
  struct Forbidden {
    std::optional<std::size_t> joint{};  ///< does not know its zero; none: there is gravity, m/s2
    double gravity_m_s2{0};
  };
  /// What a cycle has brought.
  struct News {
    std::size_t found{0};  ///< so many joints have their zero now, told with each; 0: none in this cycle
    bool done{false};
    std::optional<Reason> failed{};
  };
  explicit Homing(const Parts& parts) noexcept : parts_{parts} {}

  /// Whether the device of the descriptor tells REFERENCED.
  [[nodiscard]] static bool told(const descriptor::SubsystemDescriptor& subsystem);
  /// Whether it has a configuration that homes.
  [[nodiscard]] static bool declared(const descriptor::SubsystemDescriptor& subsystem);
  /// Calls `publish(name, cell)` for each parameter of it: of an arm whose device tells, and of one that homes besides.
  template <class Publish>
  void each_of_references(const Publish& publish) {
    publish("REFERENCED", referenced_);
  }
  template <class Publish>
  void each(const Publish& publish) {
    publish("HOMING", values_);
    publish("HOMING_JOINT", goes_);
  }

  /// In configure().  Mismatch: another length than the robot has joints; InvalidArgument: what is declared homes nobody.
  /// Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<> begin(double cycle_s);
  /// The configuration homes: nothing goes by the model.
  [[nodiscard]] bool in_force() const noexcept { return search_.has_value(); }
  /// What is measured of this joint is from its zero.
  [[nodiscard]] bool knows(std::size_t joint) const noexcept { return parts_.drives.referenced(joint); }
  /// Why it may not act in this configuration.
  [[nodiscard]] std::optional<Forbidden> forbids() const noexcept;
  /// Of one that is in force: why what is declared, or was written since, homes nobody.
  [[nodiscard]] std::optional<Reason> unfit() const noexcept;

  // --- in each cycle ------------------------------------------------------------------------------------------------------
  /// Behind what is measured: REFERENCED. Whether a joint has found its zero in this cycle, or lost it.
  [[nodiscard]] bool update() noexcept;

  // --- of one that is in force --------------------------------------------------------------------------------------------
  /// Takes the present place as the reference, and looks for nothing.
  void engage() noexcept;
  /// HOME, at rest: those that do not know their zero find it, one by one.
  [[nodiscard]] Outcome home() noexcept;
  [[nodiscard]] News advance() noexcept;
  /// Who looks comes to rest.
  void end() noexcept;
  [[nodiscard]] bool at_rest() const noexcept { return search_->at_rest(); }
  [[nodiscard]] const JointVector& wanted() const noexcept { return search_->now().position; }
  /// A cycle of the law: what it finds is put out and told.
  void control() noexcept;
  /// What the law would give to this joint if it were to be so far away; engage() follows.
  [[nodiscard]] double answer(std::size_t joint, double deviation) noexcept;

 private:
  [[nodiscard]] HomeSearch::Sees sees() const noexcept;
  [[nodiscard]] Result<> check_references() const noexcept;
  [[nodiscard]] Result<> check_values() const noexcept;
  [[nodiscard]] Joints most_torque() const noexcept;
  void tell_looking() noexcept;
  [[nodiscard]] JointVector torque(const Setpoint& wanted) noexcept;

  Parts parts_;
  Parameter<JointFlags> referenced_;
  Parameter<HomingValues> values_;
  Parameter<std::uint8_t> goes_;
  JointFlags references_;  ///< of this cycle
  std::optional<HomeSearch> search_;
  std::optional<HomingLaw> law_;
};

}  // namespace hirosco::robot_arm
