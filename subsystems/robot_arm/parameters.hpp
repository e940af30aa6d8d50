// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/parameter/parameter.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"

namespace hirosco::robot_arm {

/// The parameters of robot_arm.xml, in its units.  Thread: the cycle, and the service loop while there is none.
struct Parameters {
  /// Calls `publish(name, cell)` for each.
  template <class Publish>
  void each(const Publish& publish) {
    publish("CUR_VALUES", current);
    publish("DES_POSITION", desired_position);
    publish("DES_VELOCITY", desired_velocity);
    publish("EXTERNAL_TORQUE", external_torque);
    publish("TOOL", tool);
    publish("TOOL_PLACE", tool_place);
    publish("TOOL_RADIUS", tool_radius_m);
    publish("MOTION", motion);
    publish("PAYLOAD", payload);
    publish("CONTACT_WATCH", contact);
    publish("GRAVITY", gravity_m_s2);
    publish("ROTOR_INERTIA", rotor_inertia);
    publish("BANDWIDTH", bandwidth_rad_s);
    publish("BANDWIDTH_IN_FORCE", bandwidth_in_force);
    publish("ACCELERATION", acceleration);
    publish("JERK", jerk);
    publish("GOAL_TOLERANCE", goal_tolerance);
    publish("TORQUE_LIMIT", torque_limit);
    publish("TORQUE_HARD", torque_hard);
    publish("SPEED_LIMIT", speed_limit);
    publish("FOLLOWING_LIMIT", following_limit);
    publish("CLEARANCE_LIMIT", clearance_limit_m);
    publish("CLEARANCE", clearance_m);
    publish("KEPT_OUT", keep_out);
    publish("LAW", law);
    publish("JOINT_STIFFNESS", joint_stiffness);
    publish("FLOAT_DAMPING", float_damping);
    publish("RETRACT_DISTANCE", retract_distance);
    publish("ACTIVE", active);
    publish("TOOL_FORCE", tool_force_n);
    publish("JOINT_POWER", joint_power_w);
    publish("TOOL_POWER", tool_power_w);
    publish("TOOL_FORCE_LIMIT", tool_force_limit_n);
    publish("POWER_LIMIT", power_limit_w);
    publish("TOOL_POWER_LIMIT", tool_power_limit_w);
    publish("DES_TORQUE", desired_torque);
  }

  Parameter<CurrentValues> current;
  Parameter<Joints> rotor_inertia, desired_position, desired_velocity, external_torque, joint_stiffness;
  Parameter<ToolValues> tool, tool_place;
  Parameter<MotionValues> motion;
  Parameter<PayloadValues> payload;
  Parameter<ContactValues> contact;
  Parameter<LawValues> law;
  Parameter<std::array<double, 3>> gravity_m_s2;
  Parameter<double> bandwidth_rad_s, bandwidth_in_force, acceleration, jerk, goal_tolerance;
  Parameter<double> torque_limit, torque_hard, speed_limit, following_limit;
  Parameter<double> clearance_limit_m, clearance_m, tool_radius_m;
  Parameter<double> float_damping, retract_distance;
  Parameter<KeepOut> keep_out;
  Parameter<std::uint8_t> active;
  Parameter<std::array<double, 3>> tool_force_n;
  Parameter<double> joint_power_w, tool_power_w, tool_force_limit_n, power_limit_w, tool_power_limit_w;
  Parameter<Joints> desired_torque;
};

}  // namespace hirosco::robot_arm
