// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/platform/database.hpp"

struct sqlite3;
struct sqlite3_stmt;

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

  struct Close {
    void operator()(sqlite3* connection) const noexcept;
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  using Connection = std::unique_ptr<sqlite3, Close>;
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

 private:
  explicit SqliteDatabase(Connection connection) : connection_{std::move(connection)} {}
  Result<> set_up(DatabaseAccess access);
  Result<> make_or_check_schema();
  Result<> run(const char* sql);
  Result<std::int64_t> number_from(const char* sql);
  Result<Statement> prepare(const char* sql);
  Result<> insert(const LogRecord& record);
  Result<> check_same(const LogRecord& record);
  Result<> do_append(std::span<const LogRecord> batch) override;
  Result<LogPage> do_read(const LogQuery& query) override;
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "sqlite"; }

  Connection connection_;   // closed after its statements
  Statement insert_;
  Statement find_;
};

}  // namespace hirosco::supervisor
