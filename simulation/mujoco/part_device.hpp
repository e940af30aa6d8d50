// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simulation/mujoco/joint_bus.hpp"
#include "simulation/mujoco/mujoco_device.hpp"

namespace hirosco::simulation {

/// Some joints of a robot as a device of their own, in the world of the device of the others (world="..." of a mission): a gripper at the
/// end of an arm. Watchdog, second inhibit, power and faults are its own; its world goes on with that other device, and has closed brakes
/// at these joints until this one drives them. Frames as of the device with the world, for these joints alone.
/// Settings and faults besides the common ones:
///   joints NAME,NAME,...   of the file, needed, before it starts: these are no longer in the other device's frames
///   noise N_M
class PartDevice final : public SimulatedDevice {
 public:
  PartDevice(FlowFactory& flows, FlowAddress address, const Settings& settings);

  [[nodiscard]] std::vector<std::string> remarks() const override;

 private:
  [[nodiscard]] Result<> make_world() override;
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override { return bus_.take(payload); }
  void write_sensors(OctetWriter& payload) noexcept override { bus_.write_sensors(whole_->robot(), payload); }
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_heal() noexcept override { bus_.set_noise(0); }
  [[nodiscard]] bool can(Stop) const noexcept override { return true; }

  MujocoDevice* whole_;  ///< in whose world it is; null: in none
  JointBus bus_;
};

}  // namespace hirosco::simulation
