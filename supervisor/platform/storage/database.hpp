// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The packet store of the supervisor (paper 4.3, database strategies): what was sent, by whom, what became of it.
namespace hirosco::supervisor {

/// What one line of the log says.
enum class LogKind : std::uint8_t {
  TelecommandReceived,   ///< somebody sent it: source = sender (0 ground), peer = the addressee
  TelecommandRefused,    ///< not permitted or not acceptable; the note says why
  TelecommandForwarded,  ///< permitted and handed to peer
  Telemetry,             ///< source = the subsystem that made it; peer = the receiver (0 ground)
  Event,                 ///< an ST[05] report
  Action,  ///< what the supervisor itself decided: mode, recovery step, start, link; the note says what
  Switched,  ///< the log goes on in another database after this record
  Gap,  ///< `lost` records from this number on were not kept
};

/// Bounded printable text; what does not fit is cut, what is not printable ASCII becomes '?'.
class Note {
 public:
  static constexpr std::size_t capacity = 118;
  constexpr Note() = default;
  constexpr Note(std::string_view text) noexcept {  // NOLINT: a note is a text
    for (char letter : text.substr(0, capacity)) text_[size_++] = letter >= ' ' && letter <= '~' ? letter : '?';
  }
  constexpr Note(const char* text) noexcept : Note{std::string_view{text}} {}  // NOLINT: as above
  [[nodiscard]] constexpr std::string_view view() const noexcept { return {text_.data(), size_}; }
  friend constexpr bool operator==(const Note& a, const Note& b) noexcept { return a.view() == b.view(); }

 private:
  std::array<char, capacity> text_{};
  std::uint8_t size_{0};
};

/// One record as it is stored. `run` and `number` together name it for ever: `run` is the on-board time at which the
/// writing log began, `number` counts from 1 within it. Numbers plus what the gaps have lost leave nothing out.
struct LogRecord {
  OnboardTime run{};
  std::uint64_t number{};
  OnboardTime stored{};
  TimePoint monotonic{};
  LogKind kind{LogKind::Telemetry};
  std::uint16_t source{};  ///< APID, 0 = ground
  std::uint16_t peer{};  ///< APID, 0 = ground or nobody
  std::uint32_t lost{};  ///< Gap only: how many numbers are missing
  Note note{};
  std::vector<std::byte> packet{};

  friend bool operator==(const LogRecord&, const LogRecord&) = default;
};

/// What the headers of a packet say without any check; 0 where they are missing.  Realtime: bounded.
struct PacketLabel {
  bool telecommand{};
  std::uint16_t apid{};
  std::uint8_t service{};
  std::uint8_t subtype{};
};
[[nodiscard]] PacketLabel label_of(Octets packet) noexcept;

/// One line for people: `12 2026-01-01T00:00:37.000000000 telecommand-refused ground>11 TC[8,1] 27 octets: wrong mode`.
[[nodiscard]] std::string describe(const LogRecord& record);
/// TAI as `2026-01-01T00:00:37.000000000`, and back (Malformed).
[[nodiscard]] std::string time_text(OnboardTime time);
[[nodiscard]] Result<OnboardTime> time_from_text(std::string_view text);

/// The last number that a Gap may have lost: as its note says, else as if they stood side by side. Its `number` and its times are those of the first.
[[nodiscard]] std::uint64_t last_lost(const LogRecord& gap) noexcept;

enum class LogEnd : std::uint8_t { Newest, Oldest };

/// All conditions hold together; of what remains `last` records at one end are answered, in order of storage.
struct LogQuery {
  std::optional<std::uint16_t> apid{};  ///< source, peer or the packet's own APID
  std::optional<std::uint8_t> service{};
  std::optional<LogKind> kind{};
  bool housekeeping{true};  ///< false: without TM[3,25]
  std::string text{};  ///< part of `words`, whatever the case of its letters
  std::function<std::string(const LogRecord&)> words{};  ///< of a record; empty = `describe`
  std::uint64_t since{0};  ///< numbers from here on
  std::optional<OnboardTime> run{};  ///< one run only
  OnboardTime stored_from{OnboardTime::min()}, stored_to{OnboardTime::max()};  ///< both included
  std::size_t last{1000};
  LogEnd end{LogEnd::Newest};
  /// No more than so many octets at the end are looked through, where a strategy would read all that is stored before them; 0: all are.
  std::uint64_t tail_octets{0};
};
[[nodiscard]] bool matches(const LogRecord& record, const LogQuery& query);

struct LogPage {
  std::vector<LogRecord> records{};
  std::uint64_t damaged{0};  ///< stored lines that do not carry their own checksum: torn or changed
};

/// What keeps a store from storing.
enum class StoreFault : std::uint8_t {
  Deleted,  ///< the file is gone from its name; a new one was begun
  Full,  ///< no space on the disk
  Unwritable,  ///< owner, rights, a read-only disk
  Damaged,  ///< an error after which nobody knows what the file holds; a new segment was begun
  Locked,  ///< another program holds it
  Unreachable,  ///< a server that does not answer, or not now
};
/// The newest trouble of a store that heals by itself.
struct StoreTrouble {
  std::uint64_t count{0};  ///< how often one began; 0 = never
  StoreFault fault{};
  bool present{false};  ///< not over yet: nothing was stored since
  std::uint64_t lost{0};  ///< records that went with it
  Error error{};
  std::string text{};  ///< cause and cure in one line
};

/// What a store in pieces has done by its limits, since it was made.
struct StoreTurnover {
  std::uint64_t begun{0};  ///< pieces, because the one before was large or old enough
  std::uint64_t removed_pieces{0};
  std::uint64_t removed_octets{0};
  std::uint64_t removed_records{0};  ///< of those that this store has written itself
  std::string newest_removed{};  ///< name of its file
};

/// Strategy seam: where records live. Longest packet: 65,542 octets.
/// Thread: one; a reader beside a writer opens a database of its own on the same path.
class Database {
 public:
  static constexpr std::size_t max_packet_octets = 65'542;
  virtual ~Database() = default;

  /// Stores all of `batch` or says why not; durable when it returns. A record that is there already in the same words
  /// is not stored twice. Unavailable: locked by somebody else, nothing was stored, try again. Any other error
  /// is final: after it this object stores nothing more (a second fsync after a failed one proves nothing), the records
  /// go to another database. May block.
  [[nodiscard]] Result<> append(std::span<const LogRecord> batch);
  [[nodiscard]] Result<LogPage> read(const LogQuery& query) { return do_read(query); }
  /// `sqlite`, `ascii`, `postgresql`, `memory`.
  [[nodiscard]] std::string_view strategy() const noexcept { return do_strategy(); }
  /// Of a store that heals by itself (`LogStore`); others have none.
  [[nodiscard]] StoreTrouble trouble() const { return do_trouble(); }
  /// Of a store in pieces; others have none.
  [[nodiscard]] StoreTurnover turnover() const { return do_turnover(); }

 private:
  virtual Result<> do_append(std::span<const LogRecord> batch) = 0;
  virtual Result<LogPage> do_read(const LogQuery& query) = 0;
  [[nodiscard]] virtual std::string_view do_strategy() const noexcept = 0;
  [[nodiscard]] virtual StoreTrouble do_trouble() const { return {}; }
  [[nodiscard]] virtual StoreTurnover do_turnover() const { return {}; }

  std::optional<Error> failed_{};
};

/// Keeps everything in memory: simulation and tests.  Thread: any.
class MemoryDatabase final : public Database {
 private:
  Result<> do_append(std::span<const LogRecord> batch) override;
  Result<LogPage> do_read(const LogQuery& query) override;
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "memory"; }

  std::mutex mutex_;
  std::vector<LogRecord> records_;
};

/// The first three in the numbers of SET_DATABASE.
enum class DatabaseStrategy : std::uint8_t { Sqlite, Ascii, Postgresql, Memory };
enum class DatabaseAccess : std::uint8_t { Write, Read };  ///< Read never creates or changes the store

/// Opens another database while a flight goes on (SET_DATABASE); null when it cannot.
using DatabaseOpener = std::function<std::unique_ptr<Database>(DatabaseStrategy)>;

/// What needs no more than a path (PostgreSQL: `open_postgresql`, InvalidArgument here).
/// NotFound: nothing to read there; Mismatch: another program's file or a later version; SystemFailure: errno.
[[nodiscard]] Result<std::unique_ptr<Database>> open_database(DatabaseStrategy strategy,
                                                              const std::filesystem::path& path,
                                                              DatabaseAccess access = DatabaseAccess::Write);

}  // namespace hirosco::supervisor

namespace hirosco {
template <>
struct EnumTexts<supervisor::LogKind> {
  using enum supervisor::LogKind;
  static constexpr auto table = enum_table<supervisor::LogKind>({
      {TelecommandReceived, "telecommand-received"},
      {TelecommandRefused, "telecommand-refused"},
      {TelecommandForwarded, "telecommand-forwarded"},
      {Telemetry, "telemetry"},
      {Event, "event"},
      {Action, "action"},
      {Switched, "switched"},
      {Gap, "gap"},
  });
};
template <>
struct EnumTexts<supervisor::DatabaseStrategy> {
  using enum supervisor::DatabaseStrategy;
  static constexpr auto table = enum_table<supervisor::DatabaseStrategy>(
      {{Sqlite, "sqlite"}, {Ascii, "ascii"}, {Postgresql, "postgresql"}, {Memory, "memory"}});
};
}  // namespace hirosco
