// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "hirosco/subsystem/cycle/control_state.hpp"
#include "hirosco/subsystem/cycle/cycle_plan.hpp"
#include "hirosco/subsystem/cycle/device_inputs.hpp"
#include "hirosco/subsystem/cycle/permit_watch.hpp"

namespace hirosco {

/// Devices and links out: what the author puts out passes to an actuator, or its declared safe output does, and consumers hear what to
/// make of a sample. Decides by ControlState, and reports nothing. Thread: the cycle's, where nothing else is said.
class ActuatorGate {
 public:
  struct Parts {
    const descriptor::SubsystemDescriptor& descriptor;
    CyclePlan& plan;
    const ControlState& control;
    const PermitWatch& permit;
    const DeviceInputs& device_inputs;
  };
  explicit ActuatorGate(const Parts& parts);

  /// Another plan: its devices show in the parameters of their outputs. Thread: service, while the cycle rests.
  void begin() noexcept;
  /// What passes to each actuator, as a parameter: one for each actuator of the descriptor.
  [[nodiscard]] std::span<const std::unique_ptr<OutputParameter>> outputs() const noexcept { return outputs_; }

  /// Devices alone, as on the way down.  Realtime: bounded, no allocation; of each device the system calls of a send (DataFlow).
  void write_devices() noexcept;
  /// Devices, then links, with what was due at `planned`.  Realtime: as write_devices().
  void write_outputs(TimePoint planned) noexcept;

 private:
  [[nodiscard]] LinkStatus link_status() const noexcept;

  Parts parts_;
  std::vector<std::unique_ptr<OutputParameter>> outputs_;
};

}  // namespace hirosco
