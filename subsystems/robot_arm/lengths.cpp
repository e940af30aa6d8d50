// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/lengths.hpp"

#include <array>
#include <string_view>

namespace hirosco::robot_arm {

Result<> check_lengths(std::size_t joints, const descriptor::SubsystemDescriptor& subsystem,
                       const Parameters& parameters, Drives& drives, const AbortPath& abort_path) noexcept {
  const auto current = parameters.current.load();
  const auto arguments_of = [&](std::string_view name) -> std::size_t {
    const descriptor::Function* function = subsystem.find_function(name);
    std::size_t numbers = 0;
    if (function != nullptr)
      for (const auto& argument : function->arguments) numbers += argument.field.count;
    return numbers;
  };
  struct Length {
    std::size_t of;
    std::size_t wanted;
    const char* text;
  };
  const bool by_torque = subsystem.find_function("TORQUE_J") != nullptr;
  const bool by_joint = subsystem.find_function("IMPEDANCE_J") != nullptr;
  const std::array lengths{
      Length{current.position.size(), joints, "CUR_VALUES.POSITION has another length than the robot has joints"},
      Length{current.velocity.size(), joints, "CUR_VALUES.VELOCITY has another length than the robot has joints"},
      Length{current.torque.size(), joints, "CUR_VALUES.TORQUE has another length than the robot has joints"},
      Length{parameters.desired_position.load().size(), joints,
             "DES_POSITION has another length than the robot has joints"},
      Length{parameters.desired_velocity.load().size(), joints,
             "DES_VELOCITY has another length than the robot has joints"},
      Length{parameters.rotor_inertia.load().size(), joints,
             "ROTOR_INERTIA has another length than the robot has joints"},
      Length{parameters.joint_stiffness.load().size(), joints,
             "JOINT_STIFFNESS has another length than the robot has joints"},
      Length{parameters.external_torque.load().size(), joints,
             "EXTERNAL_TORQUE has another length than the robot has joints"},
      Length{drives.says().position.size(), joints, "ARM's POSITION has another length than the robot has joints"},
      Length{drives.says().velocity.size(), joints, "ARM's VELOCITY has another length than the robot has joints"},
      Length{drives.says().torque.size(), joints, "ARM's TORQUE has another length than the robot has joints"},
      Length{drives.puts_out().size(), joints, "ARM's output TORQUE has another length than the robot has joints"},
      Length{arguments_of("MOVE_J"), joints + 1, "MOVE_J takes a number for each joint, and SPEED"},
      Length{arguments_of("JOG_J"), joints + 1, "JOG_J takes a number for each joint, and SECONDS"},
      Length{by_joint ? arguments_of("IMPEDANCE_J") : joints + 1, joints + 1,
             "IMPEDANCE_J takes a number for each joint, and DAMPING"},
      Length{by_torque ? arguments_of("TORQUE_J") : joints + 1, joints + 1,
             "TORQUE_J takes a number for each joint, and SECONDS"},
      Length{parameters.desired_torque.load().size(), joints,
             "DES_TORQUE has another length than the robot has joints"},
      Length{arguments_of("MOVE_P"), 8, "MOVE_P takes POSITION[3], ORIENTATION[4], SPEED"},
      Length{arguments_of("MOVE_L"), 9, "MOVE_L takes POSITION[3], ORIENTATION[4], SPEED, TURNING"},
      Length{arguments_of("JOG_L"), 7, "JOG_L takes LINEAR[3], ANGULAR[3], SECONDS"},
  };
  for (const Length& length : lengths)
    if (length.of != length.wanted) return fail(ErrorCode::Mismatch, length.text, static_cast<std::int64_t>(length.of));
  if (AbortPath::declared(subsystem) && !abort_path.has_length(joints))
    return fail(ErrorCode::Mismatch, "JOINTS of ABORT_PATH has another length than the robot has joints");
  return ok();
}

}  // namespace hirosco::robot_arm
