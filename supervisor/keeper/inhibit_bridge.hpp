// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/process_threads.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/keeper/kept.hpp"

namespace hirosco::supervisor {

/// From a supervisor's death until the next one's guard takes over, tells each device on the endnode of its second inhibit what the
/// guard told it last: enabled under this epoch, or not. Never more than that, and no longer than a subsystem goes on without a
/// supervisor; then, or when somebody asks for a stop, nothing is enabled any more.
class InhibitBridge {
 public:
  /// A device takes what it was told for withdrawn after 50 ms.
  static constexpr Duration pace = std::chrono::milliseconds{5};
  /// While the dying process still has endnodes, and how long that may be.
  static constexpr Duration pace_of_opening = std::chrono::milliseconds{1};
  static constexpr Duration longest_opening = std::chrono::milliseconds{200};

  InhibitBridge(KeeperPage& page, FlowFactory& flows, std::vector<FlowAddress> endnodes);
  ~InhibitBridge();
  InhibitBridge(const InhibitBridge&) = delete;
  InhibitBridge& operator=(const InhibitBridge&) = delete;

  /// A supervisor was started, a child of the caller: the end of its guard's thread begins it, before the system tells of the end of the process, which on a busy
  /// computer comes when the devices have stopped (docs/adr/0135). Does nothing where no thread can be had: the devices stop.
  void watch(int supervisor);
  /// That supervisor has ended, as its process handle tells.
  void begin();
  /// The flight ends with the supervisor that it has: what the end of its guard begins would keep devices enabled for nobody.
  void nobody_goes_on() noexcept { forbidden_.store(true); }
  /// Nothing is enabled any more. Also before begin().
  void stop() noexcept;
  /// Whose end leaves nobody who tells the devices, and this has not seen to it yet: the number of that start.
  [[nodiscard]] std::optional<std::uint32_t> lost() const noexcept;
  /// The same for whoever steps it himself.
  void begin_at(TimePoint now);
  /// Tells all once, or lets go of them.  \return false when there is nothing to do any more. Thread: the bridge's, or a test's.
  bool step(TimePoint now) noexcept;

 private:
  void await(std::uint32_t start);
  void open(TimePoint now);
  [[nodiscard]] bool has_all() const noexcept;
  void let_go() noexcept;
  void run();
  void go_between(std::uint32_t lost);

  struct Line {
    FlowAddress address;
    std::unique_ptr<DataFlow> flow;
  };
  KeeperPage& page_;
  FlowFactory& flows_;
  std::vector<Line> lines_;
  std::optional<TimePoint> until_;
  std::uint32_t start_{0};  ///< the supervisor that is waited for, or has taken over
  std::atomic<std::uint32_t> told_{0};  ///< the newest start whose end is known
  Mutex mutex_;
  ProcessThreads supervisor_ HIROSCO_GUARDED_BY(mutex_);  ///< of the newest one
  std::atomic<bool> forbidden_{false};
  std::atomic<bool> ending_{false};
  Thread thread_;
};

}  // namespace hirosco::supervisor
