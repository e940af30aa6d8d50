// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/parameter/parameter.hpp"
#include "subsystems/manipulator/manipulator_data.hpp"

namespace hirosco::manipulator {

/// The parameters that every arm has, in the units of its descriptor.  Thread: the cycle, and the service loop while there is none.
struct Parameters {
  /// Calls `publish(name, cell)` for each.
  template <class Publish>
  void each(const Publish& publish) {
    publish("CUR_VALUES", current);
    publish("DES_POSITION", desired_position);
    publish("DES_VELOCITY", desired_velocity);
    publish("KP", kp);
    publish("KD", kd);
    publish("TORQUE_LIMIT", torque_limit);
    publish("TORQUE_HARD", torque_hard);
    publish("TEMP_LIMITS", temperature_limits);
    publish("POS_SCALE", position_scale);
    publish("CLUTCH", clutch);
    publish("TRAJ", trajectory);
    publish("ACTIVE", active);
    publish("GOAL_TOLERANCE", goal_tolerance);
    publish("GAINS", gains);
  }

  Parameter<CurrentValues> current;
  Parameter<Joints> desired_position, desired_velocity;
  Parameter<double> kp, kd, torque_limit, torque_hard, position_scale, goal_tolerance;
  Parameter<std::array<float, 3>> temperature_limits;
  Parameter<ClutchValues> clutch;
  Parameter<TrajectoryValues> trajectory;
  Parameter<std::uint8_t> active;
  Parameter<GainValues> gains;
};

}  // namespace hirosco::manipulator
