// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/on_board_model.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/torque_control.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// How an arm gives way (adr 0117): which law is in force, and what it does about a contact.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Yielding {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    OnBoardModel& model;
    Obstacles& obstacles;
    Guidance& guidance;
    TorqueControl& control;
    const Parameters& parameters;
  };
  /// Of a contact.
  enum class Reaction : std::uint8_t {
    None,
    Stop,  ///< stands where it was met
    Float,  ///< gives way from then on
    Retract,  ///< backs off by the way it came, then stands
  };
  /// N m or N of the joint, from 0, that feels most of it; the limit with what stood there when its motion began.
  struct Contact {
    std::size_t joint{0};
    double torque{0};
    double limit{0};
    std::uint8_t reaction{0};
  };
  /// What the arm was about when it was met.
  struct Doing {
    bool stood{false};  ///< it rested, and nobody waited for a motion
    bool stopping{false};  ///< STOP is under way
  };
  explicit Yielding(const Parts& parts) noexcept : parts_{parts} {}

  /// Takes the present position as the reference, and is hard: entering Operational moves nothing.
  void engage() noexcept;
  /// Another law from now on, where the arm is.
  void take_law(LawKind kind) noexcept;
  /// Comes to rest; who is led stands where he is.
  void stand() noexcept;
  /// Stands before links meet: whoever leads it there has it float no more, however hard he pushes, until arm().
  void stand_apart() noexcept;

  /// What acts from outside already counts from now on, too; or stands beside, where a motion begins with it, and what comes to it counts.
  enum class Before : std::uint8_t { Counts, Stands };
  /// Whoever is met from now on is told, whatever was told before.
  void arm(Before load) noexcept;

  /// Each cycle: what it met, once for each time; nothing mostly.
  [[nodiscard]] std::optional<Contact> meet() noexcept;
  /// To whatever is met now.
  [[nodiscard]] Reaction reaction() const noexcept;
  /// Who backs off and meets somebody else stands; so does who is stopped, and who stood: it is not he who went there.
  void react(const Doing& doing) noexcept;

  // --- functions, at rest -------------------------------------------------------------------------------------------------
  /// Stiffness of each joint, and damping.
  [[nodiscard]] Outcome soften_joints(const FunctionValues& values) noexcept;
  [[nodiscard]] Outcome soften_tool(double stiffness_n_m, double turning_n_m, double damping) noexcept;
  /// FLOAT: carried and damped alone from now on. Who moves on the way there would go on: it has to stand, as measured, too.
  [[nodiscard]] Outcome let_go() noexcept;
  /// Hard again, where it is.
  void harden() noexcept;

 private:
  [[nodiscard]] std::optional<std::size_t> still_moves() const noexcept;
  [[nodiscard]] Outcome soften(LawKind kind, const Impedance& impedance) noexcept;
  [[nodiscard]] double counts_from(Eigen::Index joint, double share, double limit) noexcept;

  Parts parts_;
  std::uint32_t contact_cycles_{0};
  bool stands_apart_{false};
  JointVector borne_;  ///< shares of efforts, of a load that stood when a motion began; of no length: none
};

}  // namespace hirosco::robot_arm
