// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "simulation/devices/simulated_device.hpp"
#include "simulation/mujoco/lent_joints.hpp"

namespace hirosco::simulation {

/// Joints of a world that another device has and lends: what is at the end of an arm, as a device of its own. Watchdog, second inhibit, power and
/// faults are its own; drives, brakes and sensors are in the world, a cycle away each way. A world that says nothing for 20 cycles leaves sensors that are no
/// numbers, which stops whoever looks at them.
/// Frames as of the device with the world: POSITION, VELOCITY, TORQUE DOUBLE[n] to the subsystem, TORQUE DOUBLE[n] from it.
/// Setting, needed:
///   borrow NAME JOINTS   joints that the other device's line lend_NAME names, as many
class LentDevice final : public SimulatedDevice {
 public:
  LentDevice(FlowFactory& flows, FlowAddress address, const Settings& settings = {});
  [[nodiscard]] bool drives() const noexcept override { return output() == DeviceOutput::Active; }

 private:
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  [[nodiscard]] bool can(Stop) const noexcept override { return true; }

  FlowFactory& flows_of_worlds_;
  std::optional<Borrower> world_;
  const LentState* told_{nullptr};
  LentCommand wanted_;
};

}  // namespace hirosco::simulation
