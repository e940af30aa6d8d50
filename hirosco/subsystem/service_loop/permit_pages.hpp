// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/subsystem/cycle/cycle.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/service_loop/cycle_orders.hpp"
#include "hirosco/subsystem/service_loop/own_loops.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What the supervisor lets a subsystem do, on the page that only it writes, and whether it lives: after a death another supervisor
/// brings a page of its own.  Thread: the service loop.
class PermitPages {
 public:
  struct Parts {
    MemoryProvider& memory;
    Channel& channel;
    CycleLoop& cycle;
    const CycleOrders& orders;
    OwnLoops& loops;
  };
  PermitPages(const Parts& parts, const PermitPage& first, TimePoint now)
      : parts_{parts}, page_{&first}, watched_at_{now} {}

  /// The one that counts.
  [[nodiscard]] const PermitPage& page() const noexcept { return *page_; }
  /// It came by the channel.
  void take(const MemoryHandle& memory);
  /// Tells the supervisor that its page is in force, once the cycle looks at it.
  void confirm();

  /// To be called in each step: how long its heartbeat has not moved, in watched time.
  void watch(TimePoint now);
  /// It is gone for good, or has been silent for longer than it may be.
  [[nodiscard]] bool unheard() const noexcept;
  /// Its end of the channel is closed.
  [[nodiscard]] bool gone() const noexcept { return gone_; }
  void note_gone() noexcept { gone_ = true; }

 private:
  Parts parts_;
  const PermitPage* page_;
  /// Of a page that came by the channel, and of the one before, at which the cycle or another loop may just look.
  Mapping memory_, before_;
  bool owed_{false};  ///< the supervisor has not been told yet that it is in force
  std::uint64_t last_heartbeat_{0};
  TimePoint watched_at_;
  Duration silent_for_{};  ///< since its heartbeat moved last, in watched time
  bool gone_{false};
};

}  // namespace hirosco
