// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/parameter/parameter.hpp"
#include "subsystems/robot_gripper/robot_gripper_data.hpp"

namespace hirosco::robot_gripper {

/// The parameters of robot_gripper.xml, in its order and its units.  Thread: the cycle, and the service loop while there is none.
struct Parameters {
  /// Calls `publish(name, cell)` for each.
  template <class Publish>
  void each(const Publish& publish) {
    publish("CUR_VALUES", current);
    publish("GAP", gap);
    publish("ROTOR_INERTIA", rotor_inertia);
    publish("FULL_WIDTH", full_width_m);
    publish("EMPTY_WIDTH", empty_width_m);
    publish("LOST_DISTANCE", lost_distance_m);
    publish("WIDTH_TOLERANCE", width_tolerance_m);
    publish("FOLLOWING_LIMIT", following_limit_m);
    publish("FORCE_TOLERANCE", force_tolerance);
    publish("FELT_FORCE", felt_force_n);
    publish("MOVE_FORCE", move_force_n);
    publish("FORCE_HARD", force_hard);
    publish("SPEED_LIMIT", speed_limit);
    publish("BANDWIDTH", bandwidth_rad_s);
    publish("ACCELERATION", acceleration);
    publish("JERK", jerk);
    publish("ACTIVE", active);
  }

  Parameter<CurrentValues> current;
  Parameter<GapValues> gap;
  Parameter<Joints> rotor_inertia;
  Parameter<double> full_width_m, empty_width_m, lost_distance_m, width_tolerance_m, following_limit_m;
  Parameter<double> force_tolerance, felt_force_n, move_force_n, force_hard, speed_limit;
  Parameter<double> bandwidth_rad_s, acceleration, jerk;
  Parameter<std::uint8_t> active;
};

}  // namespace hirosco::robot_gripper
