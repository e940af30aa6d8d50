// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: log writer (docs/safety/modules.csv).
#include "supervisor/platform/storage/log_writer.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace hirosco::supervisor {
namespace {

/// Longest time the queue is locked by the writer: this many records are copied.
constexpr std::size_t records_per_lock = 64;
/// A database locked by somebody else is asked again this often.
constexpr Duration locked_database_pause = 50ms;

}  // namespace

StoreTurnover together(StoreTurnover before, const StoreTurnover& now) {
  before.begun += now.begun;
  before.removed_pieces += now.removed_pieces;
  before.removed_octets += now.removed_octets;
  before.removed_records += now.removed_records;
  if (!now.newest_removed.empty()) before.newest_removed = now.newest_removed;
  return before;
}

LogEntry switch_note(const Database& next) {
  std::string text = "the log goes on in: ";
  text += next.strategy();
  return {.kind = LogKind::Switched, .packet = {}, .note = Note{text}};
}

LogWriter::LogWriter(const Clock& clock, std::unique_ptr<Database> database, Options options)
    : clock_{clock},
      options_{std::move(options)},
      queue_{options_.limits, clock.onboard()},
      database_{std::move(database)},
      batch_{options_.batch_records} {
  if (options_.resume) {
    queue_.resume(*options_.resume, clock.onboard(), clock.now());
    durable_.store(options_.resume->durable);  // who asks is never told less than the one before had told
  }
  run_ = queue_.run();
}

void LogWriter::start(const std::shared_ptr<LogWriter>& writer) {
  writer->thread_ = std::thread{[writer] { writer->work(); }};
}

std::uint64_t LogWriter::append(const LogEntry& entry) {
  std::uint64_t number{};
  bool wake{};
  {
    const LockGuard lock{mutex_};
    const bool was_empty = queue_.empty();
    const bool was_urgent = urgent();
    number = queue_.push(entry, clock_.onboard(), clock_.now());  // under the lock: times follow the numbers
    if (options_.number != nullptr) options_.number->store(queue_.last_number(), std::memory_order_release);
    high_water_ = std::max<std::uint64_t>(high_water_, queue_.waiting());
    wake = was_empty || (!was_urgent && urgent());
  }
  if (wake) work_.post();
  return number;
}

void LogWriter::switch_to(std::unique_ptr<Database> next) {
  std::unique_ptr<Database> never_used;
  {
    const LockGuard lock{mutex_};
    if (!failure_) queue_.push(switch_note(*next), clock_.onboard(), clock_.now());
    switch_after_ = queue_.last_number();
    never_used = std::exchange(next_database_, std::move(next));
    ++switches_;
  }
  work_.post();
}

std::optional<Error> LogWriter::failure() {
  const LockGuard lock{mutex_};
  if (failure_) return failure_;
  return trouble_.present ? std::optional{trouble_.error} : std::nullopt;
}

StoreTrouble LogWriter::trouble() {
  const LockGuard lock{mutex_};
  return trouble_;
}

LogCounters LogWriter::counters() {
  const LockGuard lock{mutex_};
  return {.accepted = queue_.last_number() - queue_.lost() - queue_.refused(),
          .lost = queue_.lost(),
          .refused = queue_.refused(),
          .durable = durable(),
          .batches = batches_,
          .failures = failures_,
          .switches = switches_,
          .high_water = high_water_,
          .turnover = together(turnover_before_, turnover_)};
}

Result<> LogWriter::flush(TimePoint deadline) {
  std::uint64_t target{};
  {
    const LockGuard lock{mutex_};
    target = queue_.last_number();
    ++flushing_;
  }
  work_.post();
  Result<> outcome = ok();
  while (durable() < target && outcome) {
    if (const auto error = failure()) outcome = fail(*error);
    else if (!progress_.wait_until(deadline)) outcome = fail(ErrorCode::Timeout, "records are not durable yet");
  }
  const LockGuard lock{mutex_};
  --flushing_;
  return outcome;
}

void LogWriter::stop(TimePoint deadline) {
  {
    const LockGuard lock{mutex_};
    stopping_ = true;
  }
  work_.post();
  const bool ended = ended_.wait_until(deadline);
  {
    // Nothing of the owner is touched after this.
    const LockGuard lock{callback_mutex_};
    options_.on_progress = nullptr;
  }
  if (ended) {
    thread_.join();
    return;
  }
  const LockGuard lock{mutex_};
  abandoned_ = true;
  thread_.detach();
}

bool LogWriter::urgent() const {
  const std::size_t enough = std::min(options_.enough_records, options_.batch_records);
  return queue_.urgent_waiting() || queue_.waiting() >= enough || flushing_ != 0 || stopping_;
}

void LogWriter::work() {
  if (options_.resume && options_.resolve) resolve(*options_.resume);
  while (next_step()) {}
  ended_.post();
}

void LogWriter::resolve(const LogResumption& noted) {
  auto found = options_.resolve(*database_, noted);
  while (!found) {
    TimePoint now{};
    {
      const LockGuard lock{mutex_};
      if (stopping_ || next_database_) return;
      now = clock_.now();  // which lives: who is abandoned is stopping
    }
    static_cast<void>(work_.wait_until(now + locked_database_pause));
    found = options_.resolve(*database_, noted);
  }
  {
    const LockGuard lock{mutex_};
    queue_.found_on_disk(found->durable);
    durable_.store(queue_.before_waiting(), std::memory_order_release);
    for (int i = 0; i < flushing_; ++i) progress_.post();
  }
  const LockGuard lock{callback_mutex_};
  if (options_.on_progress) options_.on_progress();
}

bool LogWriter::next_step() {
  switch_database_if_due();
  TimePoint now{};
  enum class Todo { Wait, Gather, Write, Pause, End } todo{};
  {
    const LockGuard lock{mutex_};
    if (abandoned_) return false;
    now = clock_.now();  // under the lock: the clock lives until the thread is abandoned
    if (!batch_.empty()) todo = failure_ ? Todo::Wait : Todo::Write;
    else if (queue_.empty()) todo = stopping_ ? Todo::End : Todo::Wait;
    else todo = urgent() || waited_ ? Todo::Write : Todo::Gather;
    if (stopping_ && (failure_ || pause_)) todo = Todo::End;
    else if (todo == Todo::Write && pause_) todo = Todo::Pause;
  }
  switch (todo) {
    case Todo::End: return false;
    case Todo::Wait: work_.wait(); break;
    case Todo::Gather:
      // Company for the first record: until its time is over or something urgent comes.
      waited_ = !work_.wait_until(now + options_.delay);
      break;
    case Todo::Pause:
      static_cast<void>(work_.wait_until(now + locked_database_pause));
      pause_ = false;
      break;
    case Todo::Write:
      waited_ = false;
      fill_batch();
      write_batch();
      break;
  }
  return true;
}

void LogWriter::switch_database_if_due() {
  std::unique_ptr<Database> old;  // closed after the lock is given back: closing may take its time
  const LockGuard lock{mutex_};
  const bool old_is_done = queue_.next_waiting() > switch_after_;
  const bool due = batch_.empty() ? old_is_done : failure_.has_value() || pause_;
  if (!next_database_ || !due) return;
  old = std::exchange(database_, std::move(next_database_));
  failure_.reset();
  trouble_.present = false;
  seen_troubles_ = 0;
  turnover_before_ = together(turnover_before_, std::exchange(turnover_, {}));
  pause_ = false;
}

void LogWriter::fill_batch() {
  std::uint64_t limit = LogQueue::none;
  for (bool more = batch_.empty(); more;) {
    const LockGuard lock{mutex_};
    if (next_database_) limit = switch_after_;
    queue_.take(batch_, records_per_lock, limit);
    more = !batch_.full() && queue_.next_waiting() <= limit && queue_.next_waiting() != LogQueue::none;
    if (!batch_.empty()) durable_after_ = queue_.empty() ? queue_.last_number() : batch_.records().back().number;
  }
}

void LogWriter::write_batch() {
  if (batch_.empty()) return;
  const Result<> stored = database_->append(batch_.records());
  if (stored) batch_.clear();  // by this thread alone, and not while somebody waits for the lock
  StoreTrouble trouble = database_->trouble();
  StoreTurnover turnover = database_->turnover();
  {
    const LockGuard lock{mutex_};
    // Counted over all databases of this log.
    if (trouble.count != seen_troubles_) trouble_count_ += trouble.count - seen_troubles_;
    seen_troubles_ = trouble.count;
    trouble.count = trouble_count_;
    trouble_ = std::move(trouble);
    turnover_ = std::move(turnover);
    if (stored) {
      ++batches_;
      durable_.store(durable_after_, std::memory_order_release);
    } else if (stored.error().code == ErrorCode::Unavailable) {
      pause_ = true;
    } else {
      failure_ = stored.error();
      ++failures_;
    }
    for (int i = 0; i < flushing_; ++i) progress_.post();
  }
  const LockGuard lock{callback_mutex_};
  if (options_.on_progress) options_.on_progress();
}

}  // namespace hirosco::supervisor
