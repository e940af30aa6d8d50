// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ground/archive/archive.hpp"

namespace hirosco::ground {

/// One prepared statement: values in, rows out.
class Archive::Statement {
 public:
  Statement(Archive& archive, const std::string& sql) : archive_{archive} {
    static_cast<void>(sqlite3_prepare_v2(archive.database_, sql.c_str(), -1, &statement_, nullptr));
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  [[nodiscard]] static std::int64_t ns(OnboardTime t) noexcept { return t.time_since_epoch().count(); }

  Statement& operator<<(std::int64_t value) {
    sqlite3_bind_int64(statement_, ++bound_, value);
    return *this;
  }
  Statement& operator<<(int value) { return *this << std::int64_t{value}; }
  Statement& operator<<(OnboardTime value) { return *this << ns(value); }
  Statement& operator<<(const std::string& value) {
    sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Statement& operator<<(const std::optional<int>& value) {
    if (value) return *this << *value;
    sqlite3_bind_null(statement_, ++bound_);
    return *this;
  }
  [[nodiscard]] bool row() {
    read_ = 0;
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) ++archive_.failures_;
    return result == SQLITE_ROW;
  }
  [[nodiscard]] bool run() { return sqlite3_step(statement_) == SQLITE_DONE; }

  [[nodiscard]] std::int64_t integer() { return sqlite3_column_int64(statement_, read_++); }
  [[nodiscard]] OnboardTime time() { return OnboardTime{Duration{integer()}}; }
  template <class T>
  [[nodiscard]] T number() {
    return static_cast<T>(integer());
  }
  [[nodiscard]] std::optional<int> optional() {
    if (sqlite3_column_type(statement_, read_) != SQLITE_NULL) return number<int>();
    ++read_;
    return std::nullopt;
  }
  [[nodiscard]] std::string text() {
    const auto* letters = reinterpret_cast<const char*>(sqlite3_column_text(statement_, read_));
    const int size = sqlite3_column_bytes(statement_, read_++);
    return letters != nullptr ? std::string{letters, static_cast<std::size_t>(size)} : std::string{};
  }
  [[nodiscard]] std::vector<std::byte> octets() {
    const auto* first = static_cast<const std::byte*>(sqlite3_column_blob(statement_, read_));
    const int size = sqlite3_column_bytes(statement_, read_++);
    return first != nullptr ? std::vector<std::byte>{first, first + size} : std::vector<std::byte>{};
  }

 private:
  Archive& archive_;
  sqlite3_stmt* statement_{nullptr};
  int bound_{0};
  int read_{0};
};

}  // namespace hirosco::ground
