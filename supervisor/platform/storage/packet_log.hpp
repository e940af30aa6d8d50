// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/platform/storage/database.hpp"
#include "supervisor/platform/storage/log_queue.hpp"

/// The way from the router to the database (decision 24).
namespace hirosco::supervisor {

/// Figures since the start. accepted + lost + refused = the last number given.
struct LogCounters {
  std::uint64_t accepted{0};      ///< records that got a number and a place
  std::uint64_t lost{0};          ///< telemetry pushed out by later records
  std::uint64_t refused{0};       ///< answered with 0
  std::uint64_t durable{0};
  std::uint64_t batches{0};
  std::uint64_t failures{0};      ///< databases that failed
  std::uint64_t switches{0};
  std::uint64_t high_water{0};    ///< most records ever waiting
  StoreTurnover turnover{};       ///< pieces begun and removed by all databases of this log
};

/// Seam: takes records in order and makes them durable.
/// What is promised: telemetry is pushed out oldest first when it finds no room, everything else is never pushed out;
/// what was pushed out or refused stands in an exact Gap record.
class PacketLog {
 public:
  virtual ~PacketLog() = default;

  /// Gives the record its number and takes it, or answers 0: no room among the telecommands and events, or a packet
  /// longer than any space packet. A telecommand that gets 0 is to be refused (failure code 11).
  /// Realtime: bounded, never waits for a disk; copies the packet. Thread: any.
  [[nodiscard]] std::uint64_t append(const LogEntry& entry) { return do_append(entry); }
  /// All records up to this number are on the disk or stand in a gap on the disk.  Realtime: wait-free. Thread: any.
  [[nodiscard]] std::uint64_t durable() const noexcept { return do_durable(); }
  /// From now on records go to `next`. What was appended before still goes to the old database as long as that works,
  /// closed by a Switched record; when it has failed, everything not yet durable goes to `next`.
  /// Realtime: bounded. Thread: any.
  void switch_to(std::unique_ptr<Database> next) { do_switch_to(std::move(next)); }
  [[nodiscard]] LogCounters counters() const { return do_counters(); }
  /// Why the present database takes nothing; empty while it works. One that does not heal by itself (`trouble`) takes
  /// nothing any more until `switch_to`.
  [[nodiscard]] std::optional<Error> failure() const { return do_failure(); }
  /// The newest trouble of the present database, also when it is over.  Thread: any.
  [[nodiscard]] StoreTrouble trouble() const { return do_trouble(); }
  /// The `run` of all records of this log.
  [[nodiscard]] OnboardTime run() const noexcept { return do_run(); }

 private:
  virtual std::uint64_t do_append(const LogEntry& entry) = 0;
  [[nodiscard]] virtual std::uint64_t do_durable() const noexcept = 0;
  virtual void do_switch_to(std::unique_ptr<Database> next) = 0;
  [[nodiscard]] virtual LogCounters do_counters() const = 0;
  [[nodiscard]] virtual std::optional<Error> do_failure() const = 0;
  [[nodiscard]] virtual StoreTrouble do_trouble() const = 0;
  [[nodiscard]] virtual OnboardTime do_run() const noexcept = 0;
};

/// Stores each record before `append` returns: simulation and tests, deterministic. While its database fails, records
/// wait in the same bounded queue.
/// Thread: one.
class DirectPacketLog final : public PacketLog {
 public:
  /// `clock` must outlive the log.
  DirectPacketLog(const Clock& clock, std::unique_ptr<Database> database, const LogQueue::Limits& limits = {});

 private:
  std::uint64_t do_append(const LogEntry& entry) override;
  [[nodiscard]] std::uint64_t do_durable() const noexcept override { return durable_; }
  void do_switch_to(std::unique_ptr<Database> next) override;
  [[nodiscard]] LogCounters do_counters() const override;
  [[nodiscard]] std::optional<Error> do_failure() const override;
  [[nodiscard]] StoreTrouble do_trouble() const override { return database_->trouble(); }
  [[nodiscard]] OnboardTime do_run() const noexcept override { return queue_.run(); }
  void store_waiting();

  const Clock& clock_;
  LogQueue queue_;
  std::unique_ptr<Database> database_;
  LogBatch batch_;
  std::optional<Error> failure_;
  std::uint64_t durable_{0};
  LogCounters counted_;
};

class LogWriter;

/// A writer thread behind the queue, group commit. A stalled disk stalls only that thread.
/// The destructor writes what waits, for at most `flush_limit`; then it gives up and leaves the thread to end by itself
/// when the disk lets go of it.
class ThreadedPacketLog final : public PacketLog {
 public:
  struct Options {
    LogQueue::Limits limits{};
    /// Most in one commit, which waits for the disk once, however many they are: what has come meanwhile goes together.
    std::size_t batch_records{4000};
    std::size_t enough_records{1000};  ///< so many wait for no further company
    /// How long telemetry, and what else may wait (LogEntry), waits for company; all other telecommands and events are written at once.
    Duration delay{5ms};
    Duration flush_limit{2s};
    /// Called by the writer thread whenever `durable` or `failure` has changed; short, never blocking (a WakeEvent).
    std::function<void()> on_progress{};
    /// Goes on with the records of a log whose program died: with their run and their numbers. Those that it did not get to the disk
    /// stand in a gap.
    std::optional<LogResumption> resume{};
    /// Asks the disk how far that log came, in the log's own thread before it stores anything: it may wait as long as the disk does, while
    /// records get their numbers and wait behind (docs/adr/0192). Empty: it does not answer yet, and is asked again. Null: what was noted
    /// is believed.
    std::function<std::optional<LogResumption>(Database&, const LogResumption&)> resolve{};
    std::atomic<std::uint64_t>* number{nullptr};  ///< of the newest record, for who resumes this one; null: nobody does
  };
  /// `clock` is the real monotonic one and must outlive the log.
  ThreadedPacketLog(const Clock& clock, std::unique_ptr<Database> database, Options options);
  ~ThreadedPacketLog() override;
  ThreadedPacketLog(const ThreadedPacketLog&) = delete;
  ThreadedPacketLog& operator=(const ThreadedPacketLog&) = delete;

  /// Waits until everything appended so far is durable. Timeout, or the failure of the database.  Realtime: blocks.
  [[nodiscard]] Result<> flush(Duration limit);

 private:
  std::uint64_t do_append(const LogEntry& entry) override;
  [[nodiscard]] std::uint64_t do_durable() const noexcept override;
  void do_switch_to(std::unique_ptr<Database> next) override;
  [[nodiscard]] LogCounters do_counters() const override;
  [[nodiscard]] std::optional<Error> do_failure() const override;
  [[nodiscard]] StoreTrouble do_trouble() const override;
  [[nodiscard]] OnboardTime do_run() const noexcept override;

  const Clock& clock_;
  Duration flush_limit_;
  std::shared_ptr<LogWriter> writer_;  // shared with its thread, which may outlive this object
};

}  // namespace hirosco::supervisor
