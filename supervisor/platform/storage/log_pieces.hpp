// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "supervisor/platform/storage/database.hpp"

/// A log in files is a row of pieces (adr 0082), numbered from 1 in order of time whatever their strategy:
/// `log.db`, `log.2.db`, `log.3.log`, `log.4.db`. Nothing is ever renamed, and a number is taken again only when no higher one exists.
namespace hirosco::supervisor {

struct LogPiece {
  int number{1};
  DatabaseStrategy strategy{DatabaseStrategy::Sqlite};  ///< Sqlite or Ascii
  std::filesystem::path path;
};

/// Where piece `number` of the log lies; `log` is any of its names. An ASCII piece ends in `.log`, one of SQLite as `log` does,
/// in `.db` where that is `.log` or nothing.
[[nodiscard]] std::filesystem::path piece_path(const std::filesystem::path& log, DatabaseStrategy strategy, int number);
/// The pieces that exist, the oldest first.
[[nodiscard]] std::vector<LogPiece> pieces_of(const std::filesystem::path& log);
/// What the log is called where it is in no file: its absolute path, without what follows the last dot.
[[nodiscard]] std::string log_name(const std::filesystem::path& log);
/// Octets on the disk, with what SQLite keeps beside it.
[[nodiscard]] std::uint64_t piece_octets(const std::filesystem::path& piece);
/// The piece is gone at once; what SQLite keeps beside it follows.
void remove_piece(const std::filesystem::path& piece);

/// The whole log as one: all pieces of every strategy, and what `beside` answers (a database that is no file); each record
/// once, by run and number. NotFound: there is nothing at all.
[[nodiscard]] Result<LogPage> read_log(const std::filesystem::path& log, const LogQuery& query,
                                       std::span<Database* const> beside = {});

}  // namespace hirosco::supervisor
