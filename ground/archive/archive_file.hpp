// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ground/archive/columns.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::ground {

/// The file of the archive with its tables, whatever their rows say: whether it is ours, the transaction that is open, its limit. What the
/// disk refuses is counted and thrown at nobody. What is stored is kept when it ends.
/// Thread: one.
class ArchiveFile {
 public:
  /// As Archive::open(). As long as somebody else is busy with it, it is waited for, until wait_for_nobody().
  [[nodiscard]] static Result<std::unique_ptr<ArchiveFile>> open(const std::string& path, std::int64_t limit_octets);
  ~ArchiveFile();
  ArchiveFile(const ArchiveFile&) = delete;
  ArchiveFile& operator=(const ArchiveFile&) = delete;

  /// From here on nobody else's business with the file holds up the live view: what it costs is counted.
  void wait_for_nobody() { database_.setBusyTimeout(0); }
  /// For statements that are prepared once; the file outlives them.
  [[nodiscard]] SQLite::Database& database() noexcept { return database_; }
  /// Additions, commits and readings that the disk refused.
  [[nodiscard]] std::uint64_t failures() const noexcept { return failures_; }

  // --- what is stored -----------------------------------------------------------------------------------------------------
  /// A transaction, unless one is open.
  void begin();
  /// What was stored since the last call is kept from now on.
  void commit();
  /// Deletes some of the oldest packets when the limit is reached, and the same share of all else.
  void keep_within_limit();
  /// A change, within the transaction.
  template <class... Values>
  bool store(const std::string& sql, const Values&... values) {
    begin();
    return counted([&] { statement(database_, sql, values...).exec(); });
  }
  /// Whether it was done; what the disk refuses is counted, and ends it.
  template <class Work>
  bool counted(Work work) {
    try {
      work();
      return true;
    } catch (const SQLite::Exception&) {
      ++failures_;
      return false;
    }
  }

  // --- what is asked: rows as far as the disk gives them ------------------------------------------------------------------
  /// `take(row)` says whether to go on.
  template <class Take, class... Values>
  void each(const Take& take, const std::string& sql, const Values&... values) {
    counted([&] {
      auto find = statement(database_, sql, values...);
      while (find.executeStep())
        if (!take(find)) return;
    });
  }
  template <class Row, class... Values>
  [[nodiscard]] std::vector<Row> all(Row (*read)(const SQLite::Statement&), const std::string& sql,
                                     const Values&... values) {
    std::vector<Row> rows;
    const auto take = [&](const SQLite::Statement& row) {
      rows.push_back(read(row));
      return true;
    };
    each(take, sql, values...);
    return rows;
  }
  template <class Row, class... Values>
  [[nodiscard]] std::optional<Row> first(Row (*read)(const SQLite::Statement&), const std::string& sql,
                                         const Values&... values) {
    std::optional<Row> found;
    const auto take = [&](const SQLite::Statement& row) {
      found = read(row);
      return false;
    };
    each(take, sql, values...);
    return found;
  }

 private:
  ArchiveFile(const std::string& path, std::int64_t limit_octets);
  /// The one number that a question has as its answer; 0 when it was refused.
  [[nodiscard]] std::int64_t number(const std::string& sql);

  SQLite::Database database_;
  std::int64_t limit_octets_;
  bool in_transaction_{false};
  std::uint64_t failures_{0};
};

}  // namespace hirosco::ground
