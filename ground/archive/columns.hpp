// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "ground/archive/records.hpp"

/// The archive's types as columns.
namespace hirosco::ground {

[[nodiscard]] inline std::int64_t ns(OnboardTime t) noexcept { return t.time_since_epoch().count(); }
[[nodiscard]] inline OnboardTime time_of(const SQLite::Column& column) {
  return OnboardTime{Duration{column.getInt64()}};
}
[[nodiscard]] inline std::optional<int> optional_of(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional{column.getInt()};
}
/// Into a packet that is read into again: its room is kept.
inline void read_octets(StoredPacket& packet, const SQLite::Column& column) {
  const auto* first = static_cast<const std::byte*>(column.getBlob());
  packet.octets.assign(first, first != nullptr ? first + column.getBytes() : first);
}

template <class Value>
void bind_one(SQLite::Statement& statement, int place, const Value& value) {
  if constexpr (std::is_same_v<Value, OnboardTime>) statement.bind(place, ns(value));
  else if constexpr (!std::is_same_v<Value, std::optional<int>>) statement.bind(place, value);
  else if (value) statement.bind(place, *value);
  else statement.bind(place);
}

/// The values of its question marks, in their order.
template <class... Values>
void bind(SQLite::Statement& statement, const Values&... values) {
  int place = 0;
  (bind_one(statement, ++place, values), ...);
}

template <class... Values>
[[nodiscard]] SQLite::Statement statement(const SQLite::Database& database, const std::string& sql,
                                          const Values&... values) {
  SQLite::Statement made{database, sql};
  bind(made, values...);
  return made;
}

}  // namespace hirosco::ground
