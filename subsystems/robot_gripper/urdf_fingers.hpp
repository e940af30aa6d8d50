// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robotics/dynamics/model.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "subsystems/robot_gripper/control/fingers.hpp"

namespace hirosco::robot_gripper {

/// What a gripper knows of its fingers by the URDF file that the setting MODEL_FILE of its device names, by the settings beside it, and by its
/// parameters.
class UrdfFingers {
 public:
  /// Whose settings are read.
  static constexpr std::string_view device = "GRIPPER";
  /// Names of the joints that drive fingers, with commas between them; none: all that the file has.
  static constexpr std::string_view fingers_setting = "FINGERS";
  /// At which end of their ranges the fingers are closed: lower, or upper.
  static constexpr std::string_view closed_setting = "CLOSED";

  UrdfFingers() = default;
  /// The words of an error that it gave live as long as it does, where it is.
  UrdfFingers(const UrdfFingers&) = delete;
  UrdfFingers& operator=(const UrdfFingers&) = delete;

  /// The file, and which of its joints drive fingers.  Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<> read(const descriptor::SubsystemDescriptor& subsystem);
  /// How many joints drive fingers, by read().
  [[nodiscard]] std::size_t joints() const noexcept { return joints_.size(); }
  /// The fingers of what was read. `rotor_inertia`: kg or kg m2 of each joint, behind its gear; `full_width_m`: 0 where the file is to tell it.
  /// Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<> reckon(const Joints& rotor_inertia, double full_width_m);
  /// The same fingers with these rotors.  Realtime: bounded. Thread: the cycle, and the service loop while there is none.
  [[nodiscard]] Result<> take_rotors(const Joints& rotor_inertia) noexcept;
  /// As last reckoned: who refers to them has them as they are.
  [[nodiscard]] const Fingers& fingers() const noexcept { return fingers_; }

 private:
  [[nodiscard]] Result<> find(std::vector<std::string> wanted);
  [[nodiscard]] std::unexpected<Error> refuse(ErrorCode code, std::string why);

  std::optional<robotics::Model> model_;
  std::vector<std::size_t> joints_;  ///< of the model, in its order
  bool closed_is_upper_{false};
  robotics::urdf::NotRead not_read_;  ///< of its file or settings, for whoever reads the refusal
  Fingers fingers_;
  Joints links_moved_;  ///< by each finger joint, without its rotor
};

}  // namespace hirosco::robot_gripper
