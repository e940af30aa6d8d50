// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/drives.hpp"

namespace hirosco::robot_gripper {

Result<> Drives::check_lengths(std::size_t joints) noexcept {
  struct Length {
    std::size_t of;
    const char* text;
  };
  const auto current = parameters_.current.load();
  for (const Length& length :
       {Length{current.position.size(), "CUR_VALUES.POSITION has another length than there are finger joints"},
        Length{current.velocity.size(), "CUR_VALUES.VELOCITY has another length than there are finger joints"},
        Length{current.torque.size(), "CUR_VALUES.TORQUE has another length than there are finger joints"},
        Length{parameters_.rotor_inertia.load().size(),
               "ROTOR_INERTIA has another length than there are finger joints"},
        Length{port_.input().position.size(), "GRIPPER's POSITION has another length than there are finger joints"},
        Length{port_.input().velocity.size(), "GRIPPER's VELOCITY has another length than there are finger joints"},
        Length{port_.input().torque.size(), "GRIPPER's TORQUE has another length than there are finger joints"},
        Length{port_.output().torque.size(),
               "GRIPPER's output TORQUE has another length than there are finger joints"}})
    if (length.of != joints) return fail(ErrorCode::Mismatch, length.text, static_cast<std::int64_t>(length.of));
  return ok();
}

void Drives::measure(State state) noexcept {
  const GripperInput& in = port_.input();
  parameters_.current.store({static_cast<std::int32_t>(state), in.position, in.velocity, in.torque, port_.flags()});
  measured_ = {in.position, in.velocity, in.torque};
  gap_ = fingers_.gap(measured_);
}

}  // namespace hirosco::robot_gripper
