// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/mujoco/joint_bus.hpp"
#include "simulation/mujoco/mujoco_device.hpp"
#include "simulation/mujoco/robot_lines.hpp"

namespace hirosco::simulation {

/// Joints in the world of another device (world="..." of a mission) as a device of their own: some of a robot's that is there, as a gripper at the
/// end of an arm, or all of another robot, which it brings along. Watchdog, second inhibit, power and faults are its own; its world goes on with that
/// other device, and has closed brakes at these joints until this one drives them. Frames as of the device with the world, for these joints alone.
/// Settings and faults besides the common ones; it needs one of the first two, before it starts:
///   joints NAME,NAME,...   of the file, or NAME/JOINT of a robot that is mounted: these are no longer in the other device's frames
///   mount NAME X,Y,Z [ROLL,PITCH,YAW]   the robot of its own files (robot_files.hpp) stands there (mount.hpp); then those of robot_lines.hpp, too
///   noise N_M
class PartDevice final : public SimulatedDevice {
 public:
  PartDevice(FlowFactory& flows, FlowAddress address, const Settings& settings);

  [[nodiscard]] std::vector<std::string> remarks() const override;

 private:
  [[nodiscard]] Result<> make_world() override;
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] bool has_world_alone() const noexcept override { return false; }
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override { return bus_.take(payload); }
  void write_sensors(OctetWriter& payload) noexcept override { bus_.write_sensors(whole_->robot(), payload); }
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_heal() noexcept override;
  [[nodiscard]] bool can(Stop) const noexcept override { return true; }

  [[nodiscard]] Result<> mount(const Words& words);
  [[nodiscard]] std::unexpected<Error> refuse(ErrorCode code, std::string why);

  MujocoDevice* whole_;  ///< in whose world it is; null: in none
  JointBus bus_;
  std::optional<std::size_t> robot_;  ///< number of its own in that world; empty: it has some joints of another one's
  RobotLines lines_;
  std::string problem_;
};

}  // namespace hirosco::simulation
