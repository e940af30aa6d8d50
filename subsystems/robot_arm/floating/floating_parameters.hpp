// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/parameter/parameter.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"

/// Structures and parameters of floating_arm.xml; what is of its arm is as of any (robot_arm_data.hpp).
namespace hirosco::robot_arm {

struct PoseValues {
  std::array<double, 3> position_m;
  std::array<double, 4> orientation_wxyz;
};
struct ErrorValues {
  double position_m;
  double orientation_deg;
};
/// Of a joint's effort, and of its velocity.
struct LimitShares {
  double torque, torque_hard, speed;
};
struct BasePose {
  std::array<double, 3> position_m;
  std::array<double, 4> orientation_wxyz;
  std::array<double, 3> rate_rad_s, velocity_m_s;
  std::uint8_t quality, free;
  std::uint32_t stamp;
};

/// TOOL_POSE, in the axes of TOOL: of whoever leads it over a real-time link (docs/adr/0245).
struct LedTool {
  std::array<double, 3> position_m;
  std::array<double, 4> orientation_wxyz;
  std::array<double, 3> velocity_m_s, turning_rad_s;
  std::uint8_t active;
};
struct ToolLeadValues {
  std::uint8_t leading;  ///< of LEADING
  std::uint32_t age_cycles;  ///< of what came last
  double distance_m, turn_rad;  ///< from the goal to where it is led
};
struct ToolLeadLimits {
  double begin_m, begin_rad;
  double distance_m, distance_rad;
};

/// In its units.  Thread: the cycle, and the service loop while there is none.
struct FloatingParameters {
  /// Calls `publish(name, cell)` for each.
  template <class Publish>
  void each(const Publish& publish) {
    publish("CUR", current);
    publish("TOOL", tool);
    publish("ERR", error);
    publish("BASE_PRED", base);
    publish("SIGMA_MIN", conditioning);
    publish("PHASE", phase);
    publish("PROGRESS", progress);
    publish("LIMITS", limits);
    publish("TOOL_SPEED", tool_speed_m_s);
    publish("GOAL_TOLERANCE", goal_tolerance_m);
    publish("CLEARANCE_LIMIT", clearance_limit_m);
    publish("CLEARANCE", clearance_m);
    publish("KEPT_OUT", keep_out);
    publish("DES_VELOCITY", desired_velocity);
    publish("ACTIVE", active);
  }
  /// Likewise for each of an arm to which is said what is at its tip.
  template <class Publish>
  void each_of_tip(const Publish& publish) {
    publish("TOOL_PLACE", tool_place);
    publish("PAYLOAD", payload);
    publish("TOOL_RADIUS", tool_radius_m);
  }

  /// Likewise for each of an arm that watches for contacts.
  template <class Publish>
  void each_of_contact(const Publish& publish) {
    publish("EXTERNAL_TORQUE", external_torque);
    publish("CONTACT_WATCH", contact);
    publish("RETRACT_DISTANCE", retract_distance);
  }

  /// Likewise for each of an arm whose force and power have limits; of one that is held by springs; and of one that is driven by torques.
  template <class Publish>
  void each_of_work(const Publish& publish) {
    publish("TOOL_FORCE", tool_force_n);
    publish("JOINT_POWER", joint_power_w);
    publish("TOOL_POWER", tool_power_w);
    publish("TOOL_FORCE_LIMIT", tool_force_limit_n);
    publish("POWER_LIMIT", power_limit_w);
    publish("TOOL_POWER_LIMIT", tool_power_limit_w);
  }
  template <class Publish>
  void each_of_laws(const Publish& publish) {
    publish("LAW", law);
    publish("JOINT_STIFFNESS", joint_stiffness);
  }
  template <class Publish>
  void each_of_drive(const Publish& publish) {
    publish("DES_TORQUE", desired_torque);
  }

  Parameter<CurrentValues> current;
  Parameter<PoseValues> tool, base;
  Parameter<ErrorValues> error;
  Parameter<double> conditioning, progress;
  Parameter<std::uint8_t> phase, active;
  Parameter<Joints> desired_velocity, external_torque;
  Parameter<ContactValues> contact;
  Parameter<double> retract_distance, float_damping;
  Parameter<LimitShares> limits;
  Parameter<double> tool_speed_m_s, goal_tolerance_m;
  Parameter<double> clearance_limit_m, clearance_m;
  Parameter<KeepOut> keep_out;
  Parameter<ToolValues> tool_place;
  Parameter<PayloadValues> payload;
  Parameter<double> tool_radius_m;
  Parameter<std::array<double, 3>> tool_force_n;
  Parameter<double> joint_power_w, tool_power_w, tool_force_limit_n, power_limit_w, tool_power_limit_w;
  Parameter<LawValues> law;
  Parameter<Joints> joint_stiffness, desired_torque;
};

}  // namespace hirosco::robot_arm
