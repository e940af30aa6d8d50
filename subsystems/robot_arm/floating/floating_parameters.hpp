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
};

}  // namespace hirosco::robot_arm
