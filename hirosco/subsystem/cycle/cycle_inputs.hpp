// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hirosco/subsystem/cycle/control_state.hpp"
#include "hirosco/subsystem/cycle/cycle_plan.hpp"
#include "hirosco/subsystem/cycle/device_inputs.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

namespace hirosco {

/// Links and devices in. Of a link it knows whether it is awaited or lost, and inhibits and tells that; of a device DeviceInputs does.
/// Thread: the cycle's, where nothing else is said.
class CycleInputs {
 public:
  struct Parts {
    CyclePlan& plan;
    ControlState& control;
    DeviceInputs& devices;
    ReportWriter& reports;
    VitalPage& vital;
  };
  explicit CycleInputs(const Parts& parts) : parts_{parts} {}

  /// Another plan: nobody has answered yet. Allocates. Thread: service, while the cycle rests.
  void begin();
  /// In the cycle that began at `started`; `counts`: it is one in which limits go on (CyclePace).
  /// Realtime: bounded, no allocation; the system calls of DeviceInputs::read(), and those of links by UDP (UdpLink).
  void read(TimePoint started, bool counts) noexcept;
  /// Whose samples start the cycle; null: nobody's.  Realtime: wait-free.
  [[nodiscard]] const LinkInputSlot* starter() const noexcept {
    return starter_ ? &parts_.plan.inputs[*starter_] : nullptr;
  }

 private:
  void read_links(TimePoint started, bool counts) noexcept;

  Parts parts_;
  std::vector<char> input_was_stale_;
  std::optional<std::size_t> starter_;  ///< of the inputs: whose samples start the cycle
};

}  // namespace hirosco
