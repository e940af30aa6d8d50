// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>

#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "supervisor/platform/storage/packet_log.hpp"

namespace hirosco::supervisor {

/// What the databases before had done, and what the present one has.
[[nodiscard]] StoreTurnover together(StoreTurnover before, const StoreTurnover& now);

/// The record that closes a database before a log goes on in the next one.
[[nodiscard]] LogEntry switch_note(const Database& next);

/// Everything that the writer thread of a ThreadedPacketLog touches; it may outlive that.
class LogWriter {
 public:
  using Options = ThreadedPacketLog::Options;
  LogWriter(const Clock& clock, std::unique_ptr<Database> database, Options options);
  static void start(const std::shared_ptr<LogWriter>& writer);
  std::uint64_t append(const LogEntry& entry);
  void switch_to(std::unique_ptr<Database> next);
  [[nodiscard]] std::uint64_t durable() const noexcept { return durable_.load(std::memory_order_acquire); }
  [[nodiscard]] OnboardTime run() const noexcept { return run_; }
  [[nodiscard]] std::optional<Error> failure();
  [[nodiscard]] StoreTrouble trouble();
  [[nodiscard]] LogCounters counters();
  Result<> flush(TimePoint deadline);
  /// Writes what waits and ends the thread; after `deadline` leaves it alone.
  void stop(TimePoint deadline);

 private:
  [[nodiscard]] bool urgent() const;
  void work();
  /// What has reached the disk is neither counted as lost nor given to it again. Where it does not say before this ends or another database
  /// is to take over, what was noted holds.
  void resolve(const LogResumption& noted);
  /// One round of the thread; false when its work is over.
  bool next_step();
  void switch_database_if_due();
  void fill_batch();
  void write_batch();

  const Clock& clock_;
  Options options_;  // on_progress guarded by callback_mutex_
  Mutex mutex_;
  Mutex callback_mutex_;
  Semaphore work_;
  Semaphore progress_;
  Semaphore ended_;
  std::thread thread_;

  // Guarded by mutex_.
  LogQueue queue_;
  std::unique_ptr<Database> next_database_;
  std::uint64_t switch_after_{0};
  std::optional<Error> failure_;
  StoreTrouble trouble_;
  std::uint64_t trouble_count_{0};
  std::uint64_t seen_troubles_{0};
  StoreTurnover turnover_;
  StoreTurnover turnover_before_;
  std::uint64_t batches_{0};
  std::uint64_t failures_{0};
  std::uint64_t switches_{0};
  std::uint64_t high_water_{0};
  int flushing_{0};
  bool stopping_{false};
  bool abandoned_{false};

  // The writer thread's own.
  std::unique_ptr<Database> database_;
  LogBatch batch_;
  std::uint64_t durable_after_{0};
  bool waited_{false};
  bool pause_{false};

  std::atomic<std::uint64_t> durable_{0};
  OnboardTime run_;
};

}  // namespace hirosco::supervisor
