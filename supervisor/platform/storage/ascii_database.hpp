// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/platform/storage/database.hpp"

namespace hirosco::supervisor {

/// One readable line per record, checksum at its end, behind one with the version; format in the README. One write and one fdatasync
/// per batch. A torn or changed line is counted at reading and never mistaken for a record. A file of another version is left alone.
class AsciiDatabase final : public Database {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Database>> open(const std::filesystem::path& path, DatabaseAccess access);
  ~AsciiDatabase() override;
  AsciiDatabase(const AsciiDatabase&) = delete;
  AsciiDatabase& operator=(const AsciiDatabase&) = delete;

 private:
  AsciiDatabase(std::filesystem::path path, int descriptor) : path_{std::move(path)}, descriptor_{descriptor} {}
  Result<> do_append(std::span<const LogRecord> batch) override;
  Result<LogPage> do_read(const LogQuery& query) override;
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "ascii"; }

  std::filesystem::path path_;
  int descriptor_;  ///< -1: for reading only
  std::string missing_;  ///< before the next record: the version, or what ends a line that a crash has cut
  std::string text_;  ///< of the batch being written; keeps its memory
};

/// Of the lines that we write. A file says it in its first line; where none does it is as of version 1, which began without.
inline constexpr std::uint32_t ascii_version = 1;
[[nodiscard]] std::string ascii_version_line(std::uint32_t version = ascii_version);
/// Nothing: it is no such line, or not a whole one.
[[nodiscard]] std::optional<std::uint32_t> version_from_ascii(std::string_view line);

/// The line of a record without the line feed, and back (Malformed: wrong form or checksum).
[[nodiscard]] std::string ascii_line(const LogRecord& record);
[[nodiscard]] Result<LogRecord> record_from_ascii(std::string_view line);

}  // namespace hirosco::supervisor
