// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: log writer (docs/safety/modules.csv).
#include "supervisor/platform/storage/packet_log.hpp"

#include <algorithm>
#include <utility>

#include "supervisor/platform/storage/log_writer.hpp"

namespace hirosco::supervisor {

// --- DirectPacketLog -------------------------------------------------------------------------------------------------

DirectPacketLog::DirectPacketLog(const Clock& clock, std::unique_ptr<Database> database, const LogQueue::Limits& limits)
    : clock_{clock}, queue_{limits, clock.onboard()}, database_{std::move(database)}, batch_{100} {}

std::uint64_t DirectPacketLog::do_append(const LogEntry& entry) {
  const std::uint64_t number = queue_.push(entry, clock_.onboard(), clock_.now());
  counted_.high_water = std::max<std::uint64_t>(counted_.high_water, queue_.waiting());
  store_waiting();
  return number;
}

void DirectPacketLog::store_waiting() {
  while (!failure_) {
    if (batch_.empty()) queue_.take(batch_);
    if (batch_.empty()) return;
    const Result<> stored = database_->append(batch_.records());
    if (!stored && stored.error().code == ErrorCode::Unavailable) return;
    if (!stored) {
      failure_ = stored.error();
      ++counted_.failures;
      return;
    }
    durable_ = queue_.empty() ? queue_.last_number() : batch_.records().back().number;
    ++counted_.batches;
    batch_.clear();
  }
}

void DirectPacketLog::do_switch_to(std::unique_ptr<Database> next) {
  if (!failure_) static_cast<void>(append(switch_note(*next)));
  counted_.turnover = together(counted_.turnover, database_->turnover());
  database_ = std::move(next);
  failure_.reset();
  ++counted_.switches;
  store_waiting();
}

std::optional<Error> DirectPacketLog::do_failure() const {
  if (failure_) return failure_;
  const StoreTrouble trouble = database_->trouble();
  return trouble.present ? std::optional{trouble.error} : std::nullopt;
}

LogCounters DirectPacketLog::do_counters() const {
  LogCounters counters = counted_;
  counters.lost = queue_.lost();
  counters.refused = queue_.refused();
  counters.accepted = queue_.last_number() - queue_.lost() - queue_.refused();
  counters.durable = durable_;
  counters.turnover = together(counted_.turnover, database_->turnover());
  return counters;
}

// --- ThreadedPacketLog -----------------------------------------------------------------------------------------------

ThreadedPacketLog::ThreadedPacketLog(const Clock& clock, std::unique_ptr<Database> database, Options options)
    : clock_{clock},
      flush_limit_{options.flush_limit},
      writer_{std::make_shared<LogWriter>(clock, std::move(database), std::move(options))} {
  LogWriter::start(writer_);
}

ThreadedPacketLog::~ThreadedPacketLog() { writer_->stop(clock_.now() + flush_limit_); }

Result<> ThreadedPacketLog::flush(Duration limit) { return writer_->flush(clock_.now() + limit); }

std::uint64_t ThreadedPacketLog::do_append(const LogEntry& entry) { return writer_->append(entry); }

std::uint64_t ThreadedPacketLog::do_durable() const noexcept { return writer_->durable(); }

void ThreadedPacketLog::do_switch_to(std::unique_ptr<Database> next) { writer_->switch_to(std::move(next)); }

LogCounters ThreadedPacketLog::do_counters() const { return writer_->counters(); }
std::optional<Error> ThreadedPacketLog::do_failure() const { return writer_->failure(); }
StoreTrouble ThreadedPacketLog::do_trouble() const { return writer_->trouble(); }
OnboardTime ThreadedPacketLog::do_run() const noexcept { return writer_->run(); }

}  // namespace hirosco::supervisor
