// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/subsystem/author/event_port.hpp"
#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/control/work_watch.hpp"

namespace hirosco::robot_arm {

/// The events of robot_arm.xml, in its units.
struct Events {
  using PairNames = Text<64>;
  using OfJoint = Event<std::uint8_t, double, double>;
  using OfWork = Event<double, double>;

  /// Calls `use(event)` for each of an arm without a sensor of force, whom nobody leads.
  template <class Use>
  void each(const Use& use) {
    use(motion_done);
    use(position_exceeded);
    use(speed_exceeded);
    use(torque_exceeded);
    use(torque_hard_exceeded);
    use(following_exceeded);
    use(contact);
    use(retracted);
    use(too_near);
    use(force_exceeded);
    use(power_exceeded);
    use(tool_power_exceeded);
  }
  /// Calls `use(event)` for each of a sensor of force.
  template <class Use>
  void each_of_force_sensor(const Use& use) {
    use(wrist_contact);
    use(force_sensor_lost);
  }
  /// Calls `use(event)` for each of an arm whose device tells which joints know their zero, and of one that homes besides.
  template <class Use>
  void each_of_references(const Use& use) {
    use(not_referenced);
  }
  template <class Use>
  void each_of_homing(const Use& use) {
    use(homing_under_gravity);
  }
  /// Calls `use(event)` for each of whoever leads.
  template <class Use>
  void each_of_lead(const Use& use) {
    use(lead_lost);
    use(lead_let_go);
    use(lead_unfit);
  }

  /// That tells of it.
  [[nodiscard]] const OfJoint& of(Excess what) const noexcept {
    return what == Excess::Position     ? position_exceeded
           : what == Excess::Speed      ? speed_exceeded
           : what == Excess::Torque     ? torque_exceeded
           : what == Excess::TorqueHard ? torque_hard_exceeded
                                        : following_exceeded;
  }
  [[nodiscard]] const OfWork& of(Work what) const noexcept {
    return what == Work::ToolForce ? force_exceeded : what == Work::Power ? power_exceeded : tool_power_exceeded;
  }

  Event<> motion_done{"MOTION_DONE"};
  /// Joint from 1, what was measured, the limit.
  OfJoint position_exceeded{"POSITION_LIMIT_EXCEEDED"}, speed_exceeded{"SPEED_LIMIT_EXCEEDED"},
      torque_exceeded{"TORQUE_LIMIT_EXCEEDED"}, torque_hard_exceeded{"TORQUE_HARD_EXCEEDED"},
      following_exceeded{"FOLLOWING_LIMIT_EXCEEDED"};
  /// Besides, how it reacts.
  Event<std::uint8_t, double, double, std::uint8_t> contact{"CONTACT"};
  /// What was measured, the limit, N or W.
  OfWork force_exceeded{"TOOL_FORCE_EXCEEDED"}, power_exceeded{"POWER_LIMIT_EXCEEDED"},
      tool_power_exceeded{"TOOL_POWER_EXCEEDED"};
  Event<double> retracted{"RETRACTED"};  ///< how far, rad or m
  Event<double, PairNames> too_near{"TOO_NEAR"};  ///< m, and who

  Event<double, double, std::uint8_t> wrist_contact{"WRIST_CONTACT"};  ///< N, N m, how it reacts
  Event<std::uint32_t> force_sensor_lost{"FORCE_SENSOR_LOST"};  ///< ms

  Event<std::uint8_t> not_referenced{"NOT_REFERENCED"};  ///< joint from 1
  Event<double> homing_under_gravity{"HOMING_UNDER_GRAVITY"};  ///< m/s2

  Event<std::uint32_t> lead_lost{"LEAD_LOST"};  ///< cycles
  Event<> lead_let_go{"LEAD_LET_GO"};
  /// Joint from 1, what was asked, the limit, and which.
  Event<std::uint8_t, double, double, std::uint8_t> lead_unfit{"LEAD_UNFIT"};
};

}  // namespace hirosco::robot_arm
