// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <latch>
#include <memory>
#include <vector>

#include "hirosco/utilities/os/semaphore.hpp"
#include "supervisor/platform/storage/packet_log.hpp"

/// Databases that stand still, break or are held by somebody else, for tests of the log.
namespace hirosco::supervisor {

/// Shares one database with the test after the log has closed it.
class Shared final : public Database {
 public:
  explicit Shared(std::shared_ptr<Database> real) : real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override { return real_->append(batch); }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "shared"; }
  std::shared_ptr<Database> real_;
};

/// A disk that stands still until it is released.
struct Stall {
  Semaphore reached;
  std::latch release{1};
};
class StalledDatabase final : public Database {
 public:
  StalledDatabase(std::shared_ptr<Stall> stall, std::shared_ptr<Database> real)
      : stall_{std::move(stall)}, real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    stall_->reached.post();
    stall_->release.wait();
    return real_->append(batch);
  }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "stalled"; }
  std::shared_ptr<Stall> stall_;
  std::shared_ptr<Database> real_;
};

/// Stores `good` batches, then half a batch and an error.
class BreakingDatabase final : public Database {
 public:
  BreakingDatabase(int good, std::shared_ptr<Database> real) : good_{good}, real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    if (good_-- > 0) return real_->append(batch);
    return fail(ErrorCode::SystemFailure, "fdatasync", EIO);
  }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "breaking"; }
  int good_;
  std::shared_ptr<Database> real_;
};

/// Somebody else holds the database for the first so many tries; in trouble as long as the test says.
class HeldDatabase final : public Database {
 public:
  struct Hold {
    std::atomic<int> tries{0};
    std::atomic<std::uint64_t> troubles{0};
    Semaphore tried;
    StoreTurnover turnover;  ///< what it says of its pieces
  };
  HeldDatabase(std::shared_ptr<Hold> hold, std::shared_ptr<Database> real)
      : hold_{std::move(hold)}, real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    hold_->tried.post();
    if (hold_->tries-- > 0) return fail(ErrorCode::Unavailable, "held");
    return real_->append(batch);
  }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "held"; }
  [[nodiscard]] StoreTrouble do_trouble() const override {
    StoreTrouble trouble;
    trouble.count = hold_->troubles;
    trouble.present = trouble.count != 0;
    trouble.error = {ErrorCode::SystemFailure, "held", ENOSPC};
    return trouble;
  }
  [[nodiscard]] StoreTurnover do_turnover() const override { return hold_->turnover; }
  std::shared_ptr<Hold> hold_;
  std::shared_ptr<Database> real_;
};

inline std::vector<LogRecord> all_of(Database& database) { return database.read({.last = 10'000'000})->records; }

/// Records and gaps leave no number out and name none twice.
inline void expect_complete(const std::vector<LogRecord>& records, std::uint64_t last_number) {
  std::uint64_t covered = 0;
  std::uint64_t before = 0;
  for (const LogRecord& record : records) {
    EXPECT_GT(record.number, before);
    before = record.number;
    covered += record.kind == LogKind::Gap ? record.lost : 1;
  }
  EXPECT_EQ(covered, last_number);
}

inline LogEntry telemetry() { return {.kind = LogKind::Telemetry, .source = 11, .packet = {}}; }
inline LogEntry telecommand() { return {.kind = LogKind::TelecommandReceived, .peer = 11, .packet = {}}; }

inline constexpr Duration long_enough = 60s;   // never waited for unless the test fails

}  // namespace hirosco::supervisor
