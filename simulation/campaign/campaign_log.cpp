// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/campaign_log.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

namespace hirosco::campaign {
namespace {

using supervisor::LogRecord;

class FaultyDatabase final : public supervisor::Database {
 public:
  explicit FaultyDatabase(Disk& disk) : disk_{disk} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    if (disk_.fault == DiskFault::Deleted) begin_anew();
    trouble_.present = disk_.fault != DiskFault::None;
    if (trouble_.present) {
      // As the real store answers: nothing counts as durable, the same records come again.
      if (noted_ != disk_.fault) ++trouble_.count;
      noted_ = disk_.fault;
      trouble_.fault = disk_.fault == DiskFault::Full ? supervisor::StoreFault::Full : supervisor::StoreFault::Damaged;
      trouble_.error = {ErrorCode::Unavailable, "the disk takes nothing"};
      trouble_.text = "the disk takes nothing";
      return fail(trouble_.error);
    }
    noted_ = DiskFault::None;
    for (const LogRecord& record : batch)
      if (!disk_.keeps || disk_.keeps(record)) disk_.records.push_back(record);
    return ok();
  }
  Result<supervisor::LogPage> do_read(const supervisor::LogQuery&) override {
    return supervisor::LogPage{disk_.records, 0};
  }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "memory"; }
  [[nodiscard]] supervisor::StoreTrouble do_trouble() const override { return trouble_; }

  /// As the real store does (adr 0036): what was there is one gap, and what comes is stored behind it.
  void begin_anew() {
    disk_.fault = DiskFault::None;
    if (disk_.records.empty()) return;
    constexpr std::string_view note = "the log was deleted or moved away with these";
    LogRecord gap = disk_.records.front();
    gap.kind = supervisor::LogKind::Gap;
    gap.source = gap.peer = 0;
    gap.packet = {};
    gap.lost = 0;
    gap.note = note;
    for (LogRecord& record : disk_.records) {
      gap.lost += record.kind == supervisor::LogKind::Gap ? record.lost : 1;
      if (record.note.view() != note) disk_.deleted.push_back(std::move(record));
    }
    disk_.records.assign(1, std::move(gap));
    ++trouble_.count;
    trouble_.fault = supervisor::StoreFault::Deleted;
    trouble_.lost = disk_.records.front().lost;
    trouble_.error = {ErrorCode::NotFound, "the log's file is gone", 0};
    trouble_.text = "the log was deleted: begun anew";
  }

  Disk& disk_;
  DiskFault noted_{DiskFault::None};
  supervisor::StoreTrouble trouble_{};
};

class SlowLog final : public supervisor::PacketLog {
 public:
  SlowLog(Disk& disk, const Clock& clock) : disk_{disk}, clock_{clock}, stored_{clock, database_on(disk)} {}

 private:
  std::uint64_t do_append(const supervisor::LogEntry& entry) override {
    const std::uint64_t number = stored_.append(entry);
    if (number != 0) waiting_.push_back({number, clock_.now()});
    return number;
  }
  [[nodiscard]] std::uint64_t do_durable() const noexcept override {
    const TimePoint now = clock_.now();
    const auto is_durable = [&](const Waiting& record) {
      return disk_.delay == Duration::zero() || (disk_.delay != Duration::max() && record.since + disk_.delay <= now);
    };
    while (!waiting_.empty() && is_durable(waiting_.front())) waiting_.pop_front();
    const std::uint64_t stored = stored_.durable();
    return waiting_.empty() ? stored : std::min(stored, waiting_.front().number - 1);
  }
  void do_switch_to(std::unique_ptr<supervisor::Database> next) override { stored_.switch_to(std::move(next)); }
  [[nodiscard]] supervisor::LogCounters do_counters() const override { return stored_.counters(); }
  [[nodiscard]] std::optional<Error> do_failure() const override { return stored_.failure(); }
  [[nodiscard]] supervisor::StoreTrouble do_trouble() const override { return stored_.trouble(); }
  [[nodiscard]] OnboardTime do_run() const noexcept override { return stored_.run(); }

  struct Waiting {
    std::uint64_t number{};
    TimePoint since{};
  };
  Disk& disk_;
  const Clock& clock_;
  supervisor::DirectPacketLog stored_;
  mutable std::deque<Waiting> waiting_;
};

class SlowReadings final : public supervisor::LogReadings {
 public:
  SlowReadings(const Disk& disk, const Clock& clock) : disk_{disk}, clock_{clock} {}

  Result<> begin(const supervisor::LogQuery& query) override {
    if (query_) return fail(ErrorCode::Unavailable, "another page of the log is being read");
    query_ = query;
    begun_ = clock_.now();
    return ok();
  }
  std::optional<Result<supervisor::LogPage>> outcome() override {
    const bool stands_still = disk_.delay == Duration::max();
    if (!query_ || stands_still || clock_.now() < begun_ + disk_.delay) return std::nullopt;
    const supervisor::LogQuery query = *std::exchange(query_, std::nullopt);
    if (disk_.fault == DiskFault::Failing) return fail(ErrorCode::SystemFailure, "the disk fails");
    supervisor::LogPage page;
    const auto take = [&](const LogRecord& record) {
      if (page.records.size() < query.last && supervisor::matches(record, query)) page.records.push_back(record);
    };
    if (query.end == supervisor::LogEnd::Oldest) {
      std::ranges::for_each(disk_.records, take);
    } else {
      std::for_each(disk_.records.rbegin(), disk_.records.rend(), take);
      std::ranges::reverse(page.records);
    }
    return page;
  }

 private:
  const Disk& disk_;
  const Clock& clock_;
  std::optional<supervisor::LogQuery> query_;
  TimePoint begun_{};
};

}  // namespace

std::unique_ptr<supervisor::Database> database_on(Disk& disk) { return std::make_unique<FaultyDatabase>(disk); }

std::unique_ptr<supervisor::PacketLog> log_on(Disk& disk, const Clock& clock) {
  return std::make_unique<SlowLog>(disk, clock);
}

std::unique_ptr<supervisor::LogReadings> readings_on(const Disk& disk, const Clock& clock) {
  return std::make_unique<SlowReadings>(disk, clock);
}

}  // namespace hirosco::campaign
