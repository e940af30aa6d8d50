// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/devices/simulated_device.hpp"
#include "simulation/mujoco/joint_bus.hpp"
#include "simulation/mujoco/mujoco_robot.hpp"
#include "simulation/mujoco/robot_lines.hpp"

namespace hirosco::simulation {

/// The joints of any robot that has a URDF file, behind one bus. The file is the one that the setting MODEL_FILE of the device names
/// in its subsystem's descriptor, or one that the mission names for the world alone; the world reads it by itself. WORLD_FILE of the
/// mission names an MJCF file, which is the world then (mujoco_scene.hpp): it has the joints of the URDF file by their names. Joints that a device in its world has (part_device.hpp) are not in its frames.
/// To the subsystem: POSITION, VELOCITY, TORQUE DOUBLE[n], n joints in the order of the file (rad or m; behind gears, friction and
/// brakes). From it: TORQUE DOUBLE[n] of the drives.
/// Without a command the brakes are closed. A controlled stop slows down by brakes that give as much as the drives, then they hold
/// with twice of it.
/// Shapes of the file that touch nothing are told at its start (remarks()).
/// Faults besides the common ones, each also a <Setting> of its mission:
///   base free   (before all that says where it is; floating_base.hpp)
///   obstacle_NAME SHAPE [SIZES] X,Y,Z [FRICTION [ROLL,PITCH,YAW]] | obstacle_NAME none   (shapes.hpp; 16 at most)
///   body_NAME SHAPE SIZES MASS X,Y,Z [FRICTION [ROLL,PITCH,YAW]] | body_NAME none | pull_NAME X Y Z   (8 at most)
///   softness SECONDS
///   force_sensor on   (as a <Setting> alone: behind TORQUE it tells FORCE and MOMENT DOUBLE[3] at the tip and FORCE_AGE UINT32) | force_sensor silent|tells
///   encoders MARK,... [BEGIN,...]   (as a <Setting> alone, all joints: they count from where they are switched on and tell REFERENCED UINT8[n] last; behind TORQUE they
///     are told REFERENCE UINT8[n]; relative_encoders.hpp) | encoders forget
///   gravity X Y Z | noise N_M, and those of its robot (robot_lines.hpp)
class MujocoDevice final : public SimulatedDevice {
 public:
  static constexpr std::array fault_lines{
      FaultLine{"mass 1.1", "every link a tenth heavier"},
      FaultLine{"friction 1 2", "2 N m more friction in every joint"},
      FaultLine{"payload 2", "2 kg at the tip, which nobody was told of"},
      FaultLine{"push 100 0 0", "somebody pushes the tip with 100 N"},
      FaultLine{"push 0 0 0", "nobody pushes the tip"},
      FaultLine{"obstacle_post cylinder 0.05,1 0.9,0,0.5 0.5", "a post, 0.05 m thick and 1 m high, stands at 0.9 m"},
      FaultLine{"obstacle_post none", "it is taken away"},
      FaultLine{"body_box box 0.05,0.05,0.05 0.3 0.9,0,0.5 0.5", "a box of 0.3 kg, which falls"},
      FaultLine{"pull_box 0 0 5", "it is pulled up with 5 N"},
      FaultLine{"body_box none", "it is taken away"},
      FaultLine{"noise 0.1", "noise of 0.1 N m in the torque sensors"},
  };

  MujocoDevice(FlowFactory& flows, FlowAddress address, const Settings& settings = {});

  /// World truth, once it is plugged in.
  [[nodiscard]] const MujocoRobot& robot() const noexcept { return *robot_; }
  /// For whoever is in the same world.
  [[nodiscard]] MujocoRobot& robot() noexcept { return *robot_; }
  [[nodiscard]] bool has_world() const noexcept { return robot_.has_value(); }
  /// A part of another device moves in its world from now on.
  void share() noexcept { shared_ = true; }
  /// From now on these joints (NAME,NAME,...) are another device's, in the order of the file. NotPermitted: it runs already. NotFound,
  /// InvalidArgument: one does not move by itself or is not its own, or none would be left.
  /// Of a robot that is mounted in its world: NAME/JOINT,..., all of them of one robot.
  [[nodiscard]] Result<std::vector<std::size_t>> hand_over(std::string_view names);
  /// Another robot stands in its world from now on, whose joints this bus has, as long as it is stepped; its number there. NotPermitted: it runs
  /// already. InvalidArgument: MuJoCo does not take it.
  [[nodiscard]] Result<std::size_t> mount(MujocoSpec robot, const Mount& at, JointBus& bus);
  [[nodiscard]] bool drives() const noexcept override { return driven_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] std::string engine() const override;

 private:
  [[nodiscard]] Result<> make_world() override;
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] bool has_world_alone() const noexcept override { return !shared_; }
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override { return bus_.take(payload); }
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_forget() noexcept override { bus_.forget_zeros(); }
  void do_heal() noexcept override;
  [[nodiscard]] bool can(Stop) const noexcept override { return true; }
  /// `why` stays until it refuses again.
  [[nodiscard]] std::unexpected<Error> refuse(ErrorCode code, std::string why);
  [[nodiscard]] Result<> stand_around(const Words& words);
  [[nodiscard]] Result<> lie_around(const Words& words);
  [[nodiscard]] Result<> differ(const Words& words);
  [[nodiscard]] Result<> feel(const Words& words);
  [[nodiscard]] Result<> count(const Words& words);

  std::optional<MujocoRobot> robot_;
  JointBus bus_;
  std::vector<JointBus*> whole_robots_{&bus_};  ///< by the robots in its world
  RobotLines lines_;
  std::string problem_;  ///< why there is no world, or what it was asked for is not done
  bool driven_{false};
  bool shared_{false};  ///< parts of others are in its world
  bool has_force_sensor_{false};
  bool force_silent_{false};
  std::array<double, 6> force_{};  ///< that it told last
  double force_age_ms_{0};
};

}  // namespace hirosco::simulation
