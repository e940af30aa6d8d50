// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"

namespace hirosco {

/// One run of the author's self test, and whether a pass is in force (adr 0073). How a run ended it reports.  Thread: the cycle's, but passed().
class SelfTestRun {
 public:
  explicit SelfTestRun(ReportWriter& reports) noexcept : reports_{reports} {}

  /// A configuration is put in force, or given back: nothing has passed.  Thread: the service loop, while the cycle rests.
  void forget() noexcept;
  /// Asked for: what had passed before counts no more. None is running.  Realtime: wait-free.
  void begin(const pus::Request& request, Duration within) noexcept;
  [[nodiscard]] bool running() const noexcept { return running_; }
  /// Whether the call that is next is the first of this run; its time begins then.  Realtime: wait-free.
  [[nodiscard]] bool first(TimePoint planned) noexcept;
  /// What the author said, of a run, in the cycle that was due at `planned`.  Realtime: wait-free.
  void take(const Result<Step>& said, TimePoint planned) noexcept;
  /// The subsystem goes to another state: a run ends, and Error-Operational voids a pass.  Realtime: wait-free.
  void leave(descriptor::State to) noexcept;
  /// Device `index` of the configuration is lost: a run ends, a pass is void.  Realtime: wait-free.
  void lose_device(std::int64_t index) noexcept;

  /// The state's node has failed.  Realtime: wait-free.
  void fail_node() noexcept;

  /// A pass is in force.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool passed() const noexcept { return passed_.load(std::memory_order_acquire); }

 private:
  /// `code`: 0 where it passed.
  void end(pus::FailureCode code, const Error& why) noexcept;

  ReportWriter& reports_;
  std::atomic<bool> passed_{false};
  bool running_{false};
  pus::Request request_{};
  Duration within_{};
  std::optional<TimePoint> begun_;
};

}  // namespace hirosco
