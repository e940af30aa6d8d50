// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "supervisor/platform/storage/database.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"

namespace hirosco::supervisor {

/// When a piece is closed and the next one begun, and how much may stay; 0 = that never happens.
struct LogLimits {
  std::uint64_t rotate_octets{0};  ///< a piece that has so many is closed
  Duration rotate_age{0};          ///< one whose first record is as old as that, by on-board time
  /// All pieces together, the one being written counted as `rotate_octets`: the oldest ones go before the next one is begun.
  std::uint64_t keep_octets{0};
};

/// A store in files that heals by itself (adr 0036) and goes from piece to piece (adr 0082): it opens in the thread that writes,
/// goes on in the newest piece if that is of its strategy, notices that its file is gone or was cut, begins a new piece after an
/// error that leaves the old one doubtful, and opens again until it can store. Whatever is wrong is answered as Unavailable:
/// nothing counts as durable, the same batch comes again.
/// Records that went with a file stand as one Gap at the beginning of the next. Thread: one, which may block.
class LogStore final : public Database {
 public:
  using Open = std::function<Result<std::unique_ptr<Database>>(const std::filesystem::path&)>;
  LogStore(DatabaseStrategy strategy, std::filesystem::path log, const LogLimits& limits = {});
  LogStore(DatabaseStrategy strategy, std::filesystem::path log, const LogLimits& limits, Open open);

 private:
  /// Which file a name means: another one behind the same name is another store.
  struct Identity {
    std::uint64_t device{0};
    std::uint64_t inode{0};
    std::uint64_t octets{0};
    [[nodiscard]] bool none() const noexcept { return inode == 0; }
    [[nodiscard]] bool same_file(const Identity& other) const noexcept {
      return device == other.device && inode == other.inode;
    }
  };
  [[nodiscard]] static Identity identity_of(const std::filesystem::path& path);
  /// A file that this store has seen under that name.
  struct Place {
    std::filesystem::path path;
    Identity file;
    [[nodiscard]] bool there() const { return !file.none() && identity_of(path).same_file(file); }
  };
  /// What this store has put where.
  struct Written {
    Place place;
    LogRecord first;  ///< without its packet
    std::uint64_t count{0};  ///< records, and what their gaps have lost
    std::uint64_t lost{0};  ///< of these, what cannot be found any more
    std::uint64_t first_lost{0};  ///< its lowest number
    Place told{};  ///< where the gap stands that says so
  };
  static constexpr std::size_t most_written = 10'000;
  /// What a look at the present piece says.
  enum class Look : std::uint8_t { Whole, Gone, Cut };

  Result<> do_append(std::span<const LogRecord> batch) override;
  Result<LogPage> do_read(const LogQuery& query) override { return read_log(log_, query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return to_text(strategy_); }
  [[nodiscard]] StoreTrouble do_trouble() const override { return trouble_; }
  [[nodiscard]] StoreTurnover do_turnover() const override { return turnover_; }

  void choose_piece();
  [[nodiscard]] bool due(OnboardTime now) const;
  void rotate();
  void remove_oldest();
  Result<> open_and_store(std::span<const LogRecord> batch);
  void learn_age();
  [[nodiscard]] std::filesystem::path ahead_path() const;
  [[nodiscard]] Look look() const;
  [[nodiscard]] bool begin_anew();
  void count_lost(Written& written, bool cut) const;
  Result<> store_gap();
  void took(std::span<const LogRecord> batch);
  void heal_from(const Error& error);
  void leave_piece();
  void go_to(int number);
  void note(StoreFault fault, const Error& error, std::string text, std::uint64_t lost = 0);

  DatabaseStrategy strategy_;
  std::filesystem::path log_;
  LogLimits limits_;
  Open open_;
  int number_{0};  ///< of the present piece; 0: none was chosen yet
  std::filesystem::path piece_;
  std::unique_ptr<Database> store_;
  Identity file_;
  Identity ahead_;  ///< the write-ahead file, once there is one
  bool ours_{false};  ///< this store has made the piece: nobody else's records stand in it
  bool stored_{false};  ///< something of this store stands in it
  std::optional<OnboardTime> born_;  ///< the piece's first record
  std::vector<Written> written_;  ///< by this store, the oldest first
  std::optional<LogRecord> gap_;  ///< of what went with a file
  StoreTrouble trouble_;
  StoreTurnover turnover_;
};

}  // namespace hirosco::supervisor
