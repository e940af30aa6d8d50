// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/drives.hpp"

#include <array>

namespace hirosco::manipulator {

Result<> Drives::check_lengths(std::size_t joints) noexcept {
  const auto current = parameters_.current.load();
  const auto clutch = parameters_.clutch.load();
  const RobotInput& in = port_.input();
  struct Length {
    std::size_t of;
    const char* text;
  };
  const std::array lengths{
      Length{parameters_.desired_velocity.load().size(), "DES_VELOCITY has another length than DES_POSITION"},
      Length{current.position_rad.size(), "CUR_VALUES.POSITION has another length than DES_POSITION"},
      Length{current.velocity_rad_per_s.size(), "CUR_VALUES.VELOCITY has another length than DES_POSITION"},
      Length{current.torque_n_m.size(), "CUR_VALUES.TORQUE has another length than DES_POSITION"},
      Length{current.temperature_deg_c.size(), "CUR_VALUES.TEMPERATURE has another length than DES_POSITION"},
      Length{clutch.robot_rad.size(), "CLUTCH.ROBOT has another length than DES_POSITION"},
      Length{clutch.handle_rad.size(), "CLUTCH.HANDLE has another length than DES_POSITION"},
      Length{parameters_.trajectory.load().target_rad.size(), "TRAJ.TARGET has another length than DES_POSITION"},
      Length{in.motor_position_rad.size(), "ROBOT's MOTOR_POSITION has another length than DES_POSITION"},
      Length{in.motor_velocity_rad_per_s.size(), "ROBOT's MOTOR_VELOCITY has another length than DES_POSITION"},
      Length{in.position_rad.size(), "ROBOT's POSITION has another length than DES_POSITION"},
      Length{in.velocity_rad_per_s.size(), "ROBOT's VELOCITY has another length than DES_POSITION"},
      Length{in.torque_n_m.size(), "ROBOT's TORQUE has another length than DES_POSITION"},
      Length{in.temperature_deg_c.size(), "ROBOT's TEMPERATURE has another length than DES_POSITION"},
      Length{port_.output().torque_n_m.size(), "ROBOT's output TORQUE has another length than DES_POSITION"},
  };
  for (const Length& length : lengths)
    if (length.of != joints) return fail(ErrorCode::Mismatch, length.text, static_cast<std::int64_t>(length.of));
  return ok();
}

void Drives::tell(State state) noexcept {
  const RobotInput& in = port_.input();
  parameters_.current.store({static_cast<std::int32_t>(state), in.position_rad, in.velocity_rad_per_s, in.torque_n_m,
                             in.temperature_deg_c, port_.flags()});
}

Measured Drives::measured() const noexcept {
  const RobotInput& in = port_.input();
  return {in.motor_position_rad, in.motor_velocity_rad_per_s, in.position_rad, in.velocity_rad_per_s, in.torque_n_m};
}

}  // namespace hirosco::manipulator
