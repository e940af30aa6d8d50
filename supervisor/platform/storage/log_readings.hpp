// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "supervisor/platform/storage/database.hpp"

namespace hirosco::supervisor {

/// Reads the log of a flight beside who writes it.  Realtime: blocks, allocates.
using LogReader = std::function<Result<LogPage>(const LogQuery&)>;

/// Of pieces beside each other, and of a PostgreSQL server where `server` says how it is reached. What the server refuses counts as damaged.
[[nodiscard]] LogReader reader_of(std::filesystem::path log, std::string server);

/// A page of the log that flies (docs/adr/0140). One at a time. Thread: the supervisor's.
class LogReadings {
 public:
  virtual ~LogReadings() = default;
  /// Unavailable: an earlier one has not ended.
  virtual Result<> begin(const LogQuery& query) = 0;
  /// Empty: not yet. Once for each begin().
  [[nodiscard]] virtual std::optional<Result<LogPage>> outcome() = 0;
};

/// At once: on virtual time.
class DirectLogReadings final : public LogReadings {
 public:
  explicit DirectLogReadings(LogReader read) : read_{std::move(read)} {}
  Result<> begin(const LogQuery& query) override;
  [[nodiscard]] std::optional<Result<LogPage>> outcome() override { return std::exchange(newest_, std::nullopt); }

 private:
  LogReader read_;
  std::optional<Result<LogPage>> newest_;
};

/// By a thread of ordinary priority: a disk that hangs holds nobody up.
class ThreadedLogReadings final : public LogReadings {
 public:
  explicit ThreadedLogReadings(LogReader read) : read_{std::move(read)} {}
  Result<> begin(const LogQuery& query) override;
  [[nodiscard]] std::optional<Result<LogPage>> outcome() override;

 private:
  LogReader read_;
  std::future<Result<LogPage>> reading_;
};

}  // namespace hirosco::supervisor
