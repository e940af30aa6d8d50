// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ground/archive/records.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace SQLite {
class Statement;
}  // namespace SQLite

/// The memory of the ground station: every packet as it came, and what the live view made of it. The packets are the
/// truth; histories and replay decode them again.
namespace hirosco::ground {

class ArchiveFile;

/// SQLite in write-ahead mode: what is committed survives the end of this process, however it comes about.
/// Thread: one.
class Archive {
 public:
  /// ":memory:" for one that is forgotten. What is oldest makes room when the file would exceed `limit_octets`.
  [[nodiscard]] static Result<std::unique_ptr<Archive>> open(const std::string& path,
                                                             std::int64_t limit_octets = std::int64_t{4} << 30);
  ~Archive();
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  /// What was added since the last call is kept from now on.
  void commit();
  /// Deletes some of the oldest packets when the limit is reached, and the same share of all else. Call once a second.
  void keep_within_limit();
  /// Additions, commits and readings that the disk refused.
  [[nodiscard]] std::uint64_t failures() const noexcept;

  void add(const StoredPacket& packet, Octets octets);
  void add(const StoredEvent& event);
  /// Its number; 0 when the disk refused it.
  [[nodiscard]] std::int64_t add(const StoredCommand& command);
  /// Nothing for command 0.
  void add(std::int64_t command, const StoredReport& report);
  void add(const StoredChange& change);
  void add(const StoredGap& gap);
  /// No gap within the span is one any more.
  void close_gaps(const Span& span);
  void add(const StoredFault& fault);
  /// Its number; 0 when the disk refused it.
  std::int64_t add(const StoredMark& mark);

  /// Times of the oldest and newest packet.
  [[nodiscard]] std::optional<Span> extent();
  /// In order of time; `take` says whether to go on.
  void packets(const Span& span, const std::function<bool(const StoredPacket&)>& take);
  enum class Housekeeping : std::uint8_t { LeftOut, Included };
  /// Newest first, from before packet number `before` on, 0: from `to` on. `take` says whether to go on.
  void packets_back(OnboardTime to, std::int64_t before, Housekeeping housekeeping,
                    const std::function<bool(const StoredPacket&)>& take);
  void packets_of(std::uint16_t apid, std::uint16_t sid, const Span& span,
                  const std::function<bool(const StoredPacket&)>& take);
  /// The newest one before a time.
  [[nodiscard]] std::optional<StoredPacket> last_of(std::uint16_t apid, std::uint16_t sid, OnboardTime before);

  struct Filter {
    Span span;
    int severity{0};  ///< the lowest
    std::string text;
    std::size_t limit{200};
    bool newest_first{true};
  };
  [[nodiscard]] std::vector<StoredEvent> events(const Filter& filter);
  /// How many of this severity and above; telecommands, likewise.
  [[nodiscard]] std::int64_t count_events(const Span& span, int severity);
  [[nodiscard]] std::int64_t count_commands(const Span& span);
  [[nodiscard]] std::vector<StoredCommand> commands(const Filter& filter);
  [[nodiscard]] std::optional<StoredCommand> command(std::int64_t number);
  [[nodiscard]] std::vector<StoredReport> reports(std::int64_t command);
  /// Of all commands, in order of time: number of the command and its report.
  [[nodiscard]] std::vector<std::pair<std::int64_t, StoredReport>> reports_in(const Span& span);
  /// The newest 10,000, as of gaps and faults. Begins with what held at the beginning of the span, or of these.
  [[nodiscard]] std::vector<StoredChange> changes(Span span);
  [[nodiscard]] std::vector<StoredGap> gaps(const Span& span);
  [[nodiscard]] std::vector<StoredFault> faults(const Span& span);
  /// The newest `limit` of a kind, "" = of every one, oldest first.
  [[nodiscard]] std::vector<StoredMark> marks(const std::string& kind, const Span& span, std::size_t limit = 10'000);

 private:
  explicit Archive(std::unique_ptr<ArchiveFile> file);

  std::unique_ptr<ArchiveFile> file_;  // ends after its statement
  std::unique_ptr<SQLite::Statement> add_packet_;
};

}  // namespace hirosco::ground
