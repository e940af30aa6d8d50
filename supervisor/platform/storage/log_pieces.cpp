// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/log_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <tuple>
#include <utility>

namespace hirosco::supervisor {

namespace fs = std::filesystem;

namespace {

constexpr const char* ascii_extension = ".log";

std::string extension_of(const fs::path& log, DatabaseStrategy strategy) {
  if (strategy == DatabaseStrategy::Ascii) return ascii_extension;
  const std::string own = log.extension().string();
  return own.empty() || own == ascii_extension ? ".db" : own;
}

/// Which piece a name means: `stem.db` the first, `stem.12.db` the twelfth; 0 = none.
int number_of(const std::string& name, const std::string& stem, const std::string& extension) {
  if (name.size() < stem.size() + extension.size() || !name.starts_with(stem) || !name.ends_with(extension)) return 0;
  const std::string_view middle =
      std::string_view{name}.substr(stem.size(), name.size() - stem.size() - extension.size());
  if (middle.empty()) return 1;
  int number = 0;
  const char* const end = middle.data() + middle.size();
  if (middle.size() < 2 || middle[0] != '.' || middle[1] == '0') return 0;
  const auto [stopped, error] = std::from_chars(middle.data() + 1, end, number);
  return error == std::errc{} && stopped == end && number > 1 ? number : 0;
}

auto name_of(const LogRecord& record) { return std::pair{record.run, record.number}; }

/// In order, each record once; of two under one number a record goes before a gap, which only says that another store has it not.
void put_in_order(std::vector<LogRecord>& records) {
  std::ranges::stable_sort(records, {}, [](const LogRecord& record) {
    return std::tuple{record.run, record.number, record.kind == LogKind::Gap};
  });
  const auto twice = std::ranges::unique(records, {}, name_of);
  records.erase(twice.begin(), twice.end());
}

}  // namespace

fs::path piece_path(const fs::path& log, DatabaseStrategy strategy, int number) {
  const std::string middle = number <= 1 ? std::string{} : fmt::format(".{}", number);
  return log.parent_path() / (log.stem().string() + middle + extension_of(log, strategy));
}

std::vector<LogPiece> pieces_of(const fs::path& log) {
  std::vector<LogPiece> pieces;
  const std::string stem = log.stem().string();
  const fs::path folder = log.parent_path();
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator{folder.empty() ? fs::path{"."} : folder, failed}) {
    const std::string name = entry.path().filename().string();
    for (const DatabaseStrategy strategy : {DatabaseStrategy::Sqlite, DatabaseStrategy::Ascii})
      if (const int number = number_of(name, stem, extension_of(log, strategy)); number != 0)
        pieces.push_back({number, strategy, folder / name});
  }
  std::ranges::sort(pieces, {}, [](const LogPiece& piece) { return std::pair{piece.number, piece.strategy}; });
  return pieces;
}

std::string log_name(const fs::path& log) {
  std::error_code failed;
  return fs::absolute(log, failed).lexically_normal().replace_extension().string();
}

std::uint64_t piece_octets(const fs::path& piece) {
  std::uint64_t octets = 0;
  for (const char* suffix : {"", "-wal"}) {
    std::error_code failed;
    const auto size = fs::file_size(fs::path{piece} += suffix, failed);
    if (!failed) octets += size;
  }
  return octets;
}

void remove_piece(const fs::path& piece) {
  std::error_code failed;
  for (const char* suffix : {"", "-wal", "-shm"}) fs::remove(fs::path{piece} += suffix, failed);
}

Result<LogPage> read_log(const fs::path& log, const LogQuery& query, std::span<Database* const> beside) {
  LogPage all;
  std::optional<Error> refused;
  int sources = 0;
  int read = 0;
  const auto take = [&](Result<LogPage> page) {
    ++sources;
    if (!page) {
      ++all.damaged;
      refused = page.error();
      return;
    }
    ++read;
    all.damaged += page->damaged;
    std::ranges::move(page->records, std::back_inserter(all.records));
  };
  for (Database* const database : beside) take(database->read(query));
  // The piece at the asked end first: the others only have what is farther from it, and a flight may rotate them away meanwhile.
  const bool oldest = query.end == LogEnd::Oldest;
  auto pieces = pieces_of(log);
  if (!oldest) std::ranges::reverse(pieces);
  for (const LogPiece& piece : pieces) {
    auto database = open_database(piece.strategy, piece.path, DatabaseAccess::Read);
    if (!database && database.error().code == ErrorCode::NotFound) continue;
    take(database ? (*database)->read(query) : fail(database.error()));
    // Not after each of hundreds of pieces: putting all in order costs more than reading one.
    if (!beside.empty() || all.records.size() < query.last) continue;
    put_in_order(all.records);
    if (all.records.size() >= query.last) break;
  }
  if (sources == 0) return fail(ErrorCode::NotFound, "no such log");
  // What cannot be read is why there is a next piece; where nothing else is, it is all that is asked for.
  if (read == 0 && refused) return fail(*refused);
  put_in_order(all.records);
  if (all.records.size() > query.last) {
    const auto last = static_cast<std::ptrdiff_t>(query.last);
    if (oldest) all.records.erase(all.records.begin() + last, all.records.end());
    else all.records.erase(all.records.begin(), all.records.end() - last);
  }
  return all;
}

}  // namespace hirosco::supervisor
