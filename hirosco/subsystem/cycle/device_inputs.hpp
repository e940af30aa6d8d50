// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "hirosco/subsystem/cycle/control_state.hpp"
#include "hirosco/subsystem/cycle/cycle_plan.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"
#include "hirosco/subsystem/cycle/self_test_run.hpp"

namespace hirosco {

/// Devices in, and what the cycle does about one that is lost, or has yet to answer: actuators inhibited, an event, a self test voided.
/// Thread: the cycle's, where nothing else is said.
class DeviceInputs {
 public:
  struct Parts {
    const descriptor::SubsystemDescriptor& descriptor;
    CyclePlan& plan;
    ControlState& control;
    SelfTestRun& self_test;
    ReportWriter& reports;
  };
  explicit DeviceInputs(const Parts& parts) noexcept : parts_{parts} {}

  /// Another plan: nobody has answered yet.  Thread: service, while the cycle rests.
  void begin() noexcept;
  /// Takes the newest frame of each device; `counts`: the cycle is one in which limits go on (CyclePace).
  /// Realtime: bounded, no allocation; of each device the system calls of a receive (DataFlow), and of a send where it falls back.
  void read(bool counts) noexcept;
  /// What a device said last is of before.  Realtime: wait-free.
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
  void tell_fall_back(std::size_t device) noexcept;
  void lose(std::size_t device) noexcept;

  Parts parts_;
  std::atomic<bool> awaits_first_answer_{false};
  std::atomic<std::uint32_t> never_answered_{0};  ///< device + 1, reason above it; 0: none
  bool awaits_device_{false};
};

}  // namespace hirosco
