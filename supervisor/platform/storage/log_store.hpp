// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "supervisor/platform/storage/database.hpp"

namespace hirosco::supervisor {

/// Where segment `number` of a store lies: `log.sqlite` is the first, `log.2.sqlite` the second.
[[nodiscard]] std::filesystem::path segment_of(const std::filesystem::path& path, int number);
/// The segments of this store that exist, the first one first; the first is named even where it does not exist.
[[nodiscard]] std::vector<std::filesystem::path> segments_of(const std::filesystem::path& path);
/// What all segments of a store have, for a reader: a record that stands in two of them is answered once.
[[nodiscard]] Result<LogPage> read_segments(DatabaseStrategy strategy, const std::filesystem::path& path,
                                            const LogQuery& query);

/// A store in files that heals by itself (adr 0036): it opens in the thread that writes, notices that its file is gone,
/// begins a new segment after an error that leaves the old one doubtful, and opens again until it can store. Whatever is
/// wrong is answered as Unavailable: nothing counts as durable, the same batch comes again.
/// Records that went with a deleted file stand as one Gap at the beginning of the next.
class LogStore final : public Database {
 public:
  using Open = std::function<Result<std::unique_ptr<Database>>(const std::filesystem::path&)>;
  LogStore(DatabaseStrategy strategy, std::filesystem::path path);
  LogStore(DatabaseStrategy strategy, std::filesystem::path path, Open open);

 private:
  /// Which file a name means: another one behind the same name is another store.
  struct Identity {
    std::uint64_t device{0};
    std::uint64_t inode{0};
    friend bool operator==(const Identity&, const Identity&) = default;
  };
  [[nodiscard]] static Identity identity_of(const std::filesystem::path& path);
  [[nodiscard]] std::filesystem::path beside(const char* suffix) const;

  Result<> do_append(std::span<const LogRecord> batch) override;
  Result<LogPage> do_read(const LogQuery& query) override { return read_segments(strategy_, path_, query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return to_text(strategy_); }
  [[nodiscard]] StoreTrouble do_trouble() const override { return trouble_; }

  Result<> open_and_store(std::span<const LogRecord> batch);
  [[nodiscard]] bool gone() const;
  void forget_gone();
  void took(std::span<const LogRecord> batch);
  void heal_from(const Error& error);
  void leave_segment();
  void note(StoreFault fault, const Error& error, std::string text);

  DatabaseStrategy strategy_;
  std::filesystem::path path_;
  Open open_;
  std::filesystem::path segment_path_;
  std::unique_ptr<Database> store_;
  Identity file_;
  Identity ahead_;  ///< the write-ahead file, once there is one
  /// What this file has taken: numbers, and the first of them.
  std::uint64_t taken_{0};
  LogRecord first_;
  std::optional<LogRecord> gap_;  ///< of what went with a deleted file
  StoreTrouble trouble_;
};

}  // namespace hirosco::supervisor
