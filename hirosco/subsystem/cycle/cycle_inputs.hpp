// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hirosco/subsystem/cycle/control_state.hpp"
#include "hirosco/subsystem/cycle/cycle_plan.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"
#include "hirosco/subsystem/cycle/self_test_run.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

namespace hirosco {

/// Links and devices in: reads them, knows which of them are awaited or lost, and inhibits and tells what is.
/// Thread: the cycle's, where nothing else is said.
class CycleInputs {
 public:
  struct Parts {
    const descriptor::SubsystemDescriptor& descriptor;
    CyclePlan& plan;
    ControlState& control;
    SelfTestRun& self_test;
    ReportWriter& reports;
    VitalPage& vital;
  };
  explicit CycleInputs(const Parts& parts) : parts_{parts} {}

  /// Another plan: nobody has answered yet. Allocates. Thread: service, while the cycle rests.
  void begin();
  /// In the cycle that began at `started`; `counts`: it is one in which limits go on (CyclePace).
  /// Realtime: bounded, no allocation, at most one system call per device.
  void read(TimePoint started, bool counts) noexcept;
  /// Whose samples start the cycle; null: nobody's.  Realtime: wait-free.
  [[nodiscard]] const LinkInputSlot* starter() const noexcept {
    return starter_ ? &parts_.plan.inputs[*starter_] : nullptr;
  }
  /// What a device said last is of before.
  [[nodiscard]] bool awaits_device() const noexcept { return awaits_device_; }

  /// Whether a device of the configuration has not answered since it was opened, and is not late yet.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool awaits_first_answer() const noexcept {
    return awaits_first_answer_.load(std::memory_order_acquire);
  }
  /// The first device that was lost before anybody had heard of it, and why.
  struct NeverAnswered {
    std::uint16_t device{0};
    descriptor::DeviceLoss reason{};
  };
  /// Since the configuration was applied.  Realtime: wait-free. Thread: any.
  [[nodiscard]] std::optional<NeverAnswered> never_answered() const noexcept;

 private:
  void read_links(TimePoint started, bool counts) noexcept;
  void read_devices(bool counts) noexcept;

  Parts parts_;
  std::vector<char> input_was_stale_;
  std::optional<std::size_t> starter_;  ///< of the inputs: whose samples start the cycle
  std::atomic<bool> awaits_first_answer_{false};
  std::atomic<std::uint32_t> never_answered_{0};  ///< device + 1, reason above it; 0: none
  bool awaits_device_{false};  ///< what a device said last is of before
};

}  // namespace hirosco
