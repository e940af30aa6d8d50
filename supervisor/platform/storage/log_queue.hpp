// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "supervisor/platform/storage/database.hpp"

namespace hirosco::supervisor {

/// What somebody asks to be logged; the log adds number and times. Records wait here; telecommands that wait until theirs is on the
/// disk do so in supervision/telecommand/waiting_for_disk.hpp.
struct LogEntry {
  LogKind kind{LogKind::Telemetry};
  std::uint16_t source{};
  std::uint16_t peer{};
  Octets packet{};
  Note note{};
  bool may_wait{false};  ///< nobody waits for it: it may have company on its way to the disk, as telemetry has
};

/// Telemetry and event reports of severity info and low may be pushed out by later ones; nothing else may.
[[nodiscard]] bool may_be_lost(const LogEntry& entry) noexcept;

/// Records on their way into a database: memory is kept from batch to batch, up to `most_kept_octets` for their packets.
class LogBatch {
 public:
  /// Ends a batch early, so that it stays small in memory and on the disk.
  static constexpr std::size_t full_octets = 1 << 20;
  static constexpr std::size_t most_kept_octets = 4 * full_octets;
  explicit LogBatch(std::size_t records = 1000) : records_(records == 0 ? 1 : records) {}
  [[nodiscard]] bool full() const noexcept { return used_ == records_.size() || octets_ >= full_octets; }
  [[nodiscard]] bool empty() const noexcept { return used_ == 0; }
  [[nodiscard]] std::span<const LogRecord> records() const noexcept { return std::span{records_}.first(used_); }
  /// The next free record, its packet empty.  Requires: not full.
  [[nodiscard]] LogRecord& add(std::size_t packet_octets);
  void clear() noexcept;
  [[nodiscard]] std::size_t kept_octets() const noexcept { return kept_octets_; }

 private:
  std::vector<LogRecord> records_;
  std::size_t used_{0};
  std::size_t octets_{0};
  std::size_t kept_octets_{0};  ///< room of all packets
};

/// The bounded queue before a database: one ring for what may be lost, one for what may not, both preallocated.
/// Numbers are given in order of arrival and leave in that order; what is lost leaves as a Gap record.
/// Realtime: push and take are bounded and do not allocate (a batch once warmed up). Thread: one at a time.
/// Where a log stood whose program died.
struct LogResumption {
  OnboardTime run{};
  std::uint64_t last{0};  ///< number of the newest record
  std::uint64_t durable{0};  ///< up to here they are on the disk
};

class LogQueue {
 public:
  struct Limits {
    std::size_t telemetry_records{16'384};
    std::size_t telemetry_octets{7 << 20};  ///< so many records of 448 octets
    std::size_t vital_records{8192};  ///< the last quarter is kept for events and actions: a flood of
    std::size_t vital_octets{4 << 20};  ///< telecommands cannot drown what the supervisor has to say
  };
  static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

  LogQueue(const Limits& limits, OnboardTime run);
  /// Numbers go on from there; what was not on the disk is missing. Before the first record.
  void resume(const LogResumption& from, OnboardTime stored, TimePoint monotonic);
  /// More of what the program that died had is on the disk than it had noted: up to this number. Before any of it is taken.
  void found_on_disk(std::uint64_t durable) noexcept;
  /// All records below what waits; before anything was taken they are on the disk.
  [[nodiscard]] std::uint64_t before_waiting() const noexcept { return empty() ? last_number_ : next_waiting() - 1; }
  /// The number, or 0 when there is no room.
  std::uint64_t push(const LogEntry& entry, OnboardTime stored, TimePoint monotonic);
  /// Moves up to `count` records with numbers up to `up_to` into the batch, as far as it has room.
  void take(LogBatch& batch, std::size_t count = none, std::uint64_t up_to = none);

  [[nodiscard]] OnboardTime run() const noexcept { return run_; }
  [[nodiscard]] bool empty() const noexcept { return next_waiting() == none; }
  /// Number of the first waiting record, `none` without one.
  [[nodiscard]] std::uint64_t next_waiting() const noexcept;
  [[nodiscard]] std::size_t waiting() const noexcept {
    return telemetry_.size() + vital_.size() + (gap_ ? 1 : 0) + (inherited_ ? 1 : 0);
  }
  /// A telecommand, an event or an action waits that may not (LogEntry::may_wait).
  [[nodiscard]] bool urgent_waiting() const noexcept {
    return vital_.size() != 0 && vital_.front().number <= newest_urgent_;
  }
  [[nodiscard]] std::uint64_t last_number() const noexcept { return last_number_; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

 private:
  struct Header {
    std::uint64_t number{};
    OnboardTime stored{};
    TimePoint monotonic{};
    LogKind kind{};
    std::uint16_t source{};
    std::uint16_t peer{};
    Note note{};
    std::size_t octets{};
  };

  /// Headers and the octets of their packets, first in first out.
  class Ring {
   public:
    Ring(std::size_t records, std::size_t octets);
    [[nodiscard]] std::size_t size() const noexcept { return back_ - front_; }
    /// Whether one more fits when a part `reserve_divisor`-th of the ring must stay free (0: none).
    [[nodiscard]] bool fits(std::size_t octets, std::size_t reserve_divisor) const noexcept;
    [[nodiscard]] bool could_ever_fit(std::size_t octets) const noexcept { return octets <= octets_.size(); }
    void push(const Header& header, Octets packet) noexcept;
    [[nodiscard]] const Header& front() const noexcept { return headers_[front_ % headers_.size()]; }
    void read_front(MutableOctets packet) const noexcept;
    void pop() noexcept;

   private:
    std::vector<Header> headers_;
    std::vector<std::byte> octets_;
    std::size_t front_{0};
    std::size_t back_{0};
    std::size_t first_octet_{0};
    std::size_t used_octets_{0};
  };
  struct Gap {
    std::uint64_t first{};
    std::uint64_t last{};
    std::uint32_t lost{};
    OnboardTime stored{};
    TimePoint monotonic{};
  };

  bool make_room(const LogEntry& entry);
  void miss(std::uint64_t number, OnboardTime stored, TimePoint monotonic);
  void take_gap(const Gap& gap, std::string_view why, LogBatch& batch) const;
  void take_from(Ring& ring, LogBatch& batch);

  OnboardTime run_;
  Ring telemetry_;
  Ring vital_;
  std::optional<Gap> inherited_;  ///< what the program had that died; before all others
  std::optional<Gap> gap_;
  std::uint64_t last_number_{0};
  std::uint64_t newest_urgent_{0};
  std::uint64_t lost_{0};
  std::uint64_t refused_{0};
};

}  // namespace hirosco::supervisor
