// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: log writer (docs/safety/modules.csv).
#include "supervisor/platform/storage/packet_log.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/semaphore.hpp"

namespace hirosco::supervisor {

namespace {

/// Longest time the queue is locked by the writer: this many records are copied.
constexpr std::size_t records_per_lock = 64;
/// A database locked by somebody else is asked again this often.
constexpr Duration locked_database_pause = 50ms;

/// What the databases before had done, and what the present one has.
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

}  // namespace

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

/// Everything that the writer thread touches.
class ThreadedPacketLog::Writer {
 public:
  Writer(const Clock& clock, std::unique_ptr<Database> database, Options options)
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

  static void start(const std::shared_ptr<Writer>& writer) {
    writer->thread_ = std::thread{[writer] { writer->work(); }};
  }

  std::uint64_t append(const LogEntry& entry) {
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

  void switch_to(std::unique_ptr<Database> next) {
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

  [[nodiscard]] std::uint64_t durable() const noexcept { return durable_.load(std::memory_order_acquire); }
  [[nodiscard]] OnboardTime run() const noexcept { return run_; }

  [[nodiscard]] std::optional<Error> failure() {
    const LockGuard lock{mutex_};
    if (failure_) return failure_;
    return trouble_.present ? std::optional{trouble_.error} : std::nullopt;
  }

  [[nodiscard]] StoreTrouble trouble() {
    const LockGuard lock{mutex_};
    return trouble_;
  }

  [[nodiscard]] LogCounters counters() {
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

  Result<> flush(TimePoint deadline) {
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

  /// Writes what waits and ends the thread; after `deadline` leaves it alone.
  void stop(TimePoint deadline) {
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

 private:
  [[nodiscard]] bool urgent() const {
    return queue_.vital_waiting() || queue_.waiting() >= options_.batch_records || flushing_ != 0 || stopping_;
  }

  void work() {
    if (options_.resume && options_.resolve) resolve(*options_.resume);
    while (next_step()) {}
    ended_.post();
  }

  /// What has reached the disk is neither counted as lost nor given to it again. Where it does not say before this ends or another database
  /// is to take over, what was noted holds.
  void resolve(const LogResumption& noted) {
    auto found = options_.resolve(*database_, noted);
    while (!found) {
      TimePoint now{};
      {
        const LockGuard lock{mutex_};
        if (abandoned_ || stopping_ || next_database_) return;
        now = clock_.now();
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

  /// One round of the thread; false when its work is over.
  bool next_step() {
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

  void switch_database_if_due() {
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

  void fill_batch() {
    std::uint64_t limit = LogQueue::none;
    for (bool more = batch_.empty(); more;) {
      const LockGuard lock{mutex_};
      if (next_database_) limit = switch_after_;
      queue_.take(batch_, records_per_lock, limit);
      more = !batch_.full() && queue_.next_waiting() <= limit && queue_.next_waiting() != LogQueue::none;
      if (!batch_.empty()) durable_after_ = queue_.empty() ? queue_.last_number() : batch_.records().back().number;
    }
  }

  void write_batch() {
    if (batch_.empty()) return;
    const Result<> stored = database_->append(batch_.records());
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
        batch_.clear();
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

ThreadedPacketLog::ThreadedPacketLog(const Clock& clock, std::unique_ptr<Database> database, Options options)
    : clock_{clock},
      flush_limit_{options.flush_limit},
      writer_{std::make_shared<Writer>(clock, std::move(database), std::move(options))} {
  Writer::start(writer_);
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
