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

  InhibitBridge(KeeperPage& page, FlowFactory& flows, std::vector<FlowAddress> endnodes);
  ~InhibitBridge();
  InhibitBridge(const InhibitBridge&) = delete;
  InhibitBridge& operator=(const InhibitBridge&) = delete;

  /// There is no guard any more. Does nothing where no thread can be had: the devices stop.
  void begin();
  /// Nothing is enabled any more. Also before begin().
  void stop() noexcept;
  /// The same for whoever steps it himself.
  void begin_at(TimePoint now);
  /// Tells all once, or lets go of them.  \return false when there is nothing to do any more. Thread: the bridge's, or a test's.
  bool step(TimePoint now) noexcept;

 private:
  void await_next();
  void open(TimePoint now);
  void let_go() noexcept;
  void run();

  struct Line {
    FlowAddress address;
    std::unique_ptr<DataFlow> flow;
  };
  KeeperPage& page_;
  FlowFactory& flows_;
  std::vector<Line> lines_;
  std::optional<TimePoint> until_;
  std::uint32_t start_{0};  ///< the supervisor that is waited for
  std::atomic<bool> ending_{false};
  Thread thread_;
};

}  // namespace hirosco::supervisor
