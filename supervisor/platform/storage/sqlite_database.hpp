// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include "supervisor/platform/storage/database.hpp"

namespace hirosco::supervisor {

/// SQLite in write-ahead mode, synchronous = FULL: a batch is one transaction, on the disk when `append` returns.
/// Table `log`, schema version in `user_version`; readable with any SQLite tool while the mission runs.
class SqliteDatabase final : public Database {
 public:
  static constexpr int application_id = 0x48525343;   ///< "HRSC"
  static constexpr int schema_version = 1;
  /// How long one call waits for somebody else's lock before it says Unavailable.
  static constexpr int busy_limit_ms = 1000;

  [[nodiscard]] static Result<std::unique_ptr<Database>> open(const std::filesystem::path& path, DatabaseAccess access);

 private:
  // What SQLite refuses leaves these as an exception and the class as an error.
  SqliteDatabase(const std::filesystem::path& path, int flags) : connection_{path, flags, busy_limit_ms} {}
  Result<> set_up(DatabaseAccess access);
  Result<> make_or_check_schema();
  Result<> insert(SQLite::Statement& statement, std::span<const LogRecord> records);
  Result<> check_same(const LogRecord& record);
  [[nodiscard]] Error error_of(const SQLite::Exception& refused, const char* what) const;
  Result<> do_append(std::span<const LogRecord> batch) override;
  Result<LogPage> do_read(const LogQuery& query) override;
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "sqlite"; }

  bool empty_{false};  ///< for reading: begun, and without a table yet
  SQLite::Database connection_;   // closed after its statements
  std::optional<SQLite::Statement> insert_;
  std::optional<SQLite::Statement> insert_many_;
  std::optional<SQLite::Statement> find_;
};

}  // namespace hirosco::supervisor
