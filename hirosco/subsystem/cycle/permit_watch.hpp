// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "hirosco/subsystem/cycle/control_state.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// The supervisor's stop, its permission and its heartbeat, as the cycle sees them on the permit page that it looks at: what it may not act
/// against inhibits the actuators. Thread: the cycle's, where nothing else is said.
class PermitWatch {
 public:
  struct Parts {
    ControlState& control;
    ReportWriter& reports;
    VitalPage& vital;
  };
  /// `first`: the page to begin with.
  PermitWatch(const PermitPage& first, const Parts& parts) noexcept
      : parts_{parts}, page_{&first}, offered_page_{&first} {}

  /// Another permit page, of a supervisor that goes on for one that died (docs/adr/0093): the next cycle looks at it. What the
  /// page before permitted holds on only where this one permits it, under the same epoch. Thread: service.
  void offer(const PermitPage& page) noexcept { offered_page_.store(&page, std::memory_order_release); }
  /// Whether the cycle looks at what was offered: what it looked at before may be given back.  Realtime: wait-free. Thread: service.
  [[nodiscard]] bool looks_at_offered() const noexcept {
    return page_.load(std::memory_order_acquire) == offered_page_.load(std::memory_order_relaxed);
  }
  /// Takes what was offered. Thread: the cycle's, or the service loop's while the cycle rests.  Realtime: wait-free.
  void take_offered() noexcept;

  /// Another configuration: only what moves from now on is a sign of life. Thread: service, while the cycle rests.
  void begin() noexcept;
  /// The cycle has this period from now on: so many of them the supervisor may be silent.  Realtime: wait-free.
  void follow(Duration sampling) noexcept;

  /// Once a cycle, before check(): has the heartbeat moved? `counts`: the cycle is one in which limits go on (CyclePace).
  /// Realtime: wait-free.
  void listen(bool counts) noexcept;
  /// Inhibits by stop flag, epoch, what is not permitted, or silence.  Realtime: wait-free.
  void check() noexcept;
  /// Operational is entered under the epoch that the page has now; check() follows.  Realtime: wait-free.
  void enter_operational() noexcept;
  /// Without a stop, and the epoch of the page is permitted.  Realtime: wait-free.
  [[nodiscard]] bool permits() const noexcept;
  /// As check() saw it last.
  [[nodiscard]] std::uint32_t checked_epoch() const noexcept { return permitted_epoch_; }

 private:
  [[nodiscard]] const PermitPage& page() const noexcept { return *page_.load(std::memory_order_relaxed); }

  Parts parts_;
  std::atomic<const PermitPage*> page_;  ///< that the cycle looks at
  std::atomic<const PermitPage*> offered_page_;
  std::uint32_t entered_epoch_{0};
  std::uint32_t permitted_epoch_{0};  ///< of the permit page, as checked in this cycle
  std::uint64_t heartbeat_{0};  ///< of the supervisor, as seen in the last cycle
  std::uint32_t silent_cycles_{0};  ///< of the supervisor
  std::uint32_t silence_limit_{1};
};

}  // namespace hirosco
