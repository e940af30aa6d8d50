// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/platform/storage/log_readings.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/telemetry.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// TC[129,11]: what ground missed comes down from the log of this flight (docs/adr/0140): what was said before there was a link, or while there
/// was none. Behind all that is said now, so many in each watch period; one range at a time, read by somebody who may wait for the disk.
/// Thread: the supervisor's.
class Retrieval final : public Watch {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    const Telemetry& telemetry;
    LogReadings* readings{nullptr};  ///< null: this deployment reads no log
  };
  /// Records read at once, and reports sent in one watch period.
  static constexpr std::size_t page_records = 400, most_at_once = 8;
  /// Gaps of one log that are looked at, the newest.
  static constexpr std::size_t most_gaps = 10'000;
  /// What was said just before is waited for so long to be on the disk.
  static constexpr Duration disk_patience{3s};

  explicit Retrieval(const Parts& parts) : parts_{parts} {}

  /// A ground asks; the same one asks anew.
  void begin(const pus::Request& asked, Octets data);
  void watch(TimePoint now) override;

 private:
  /// What is read: the reports, page by page; then, as its end counts it, what the log lacks of them: its gaps; where one began before the times
  /// asked for, what stands just before these; and the first record that it still has, as what it does not keep leaves no gap.
  enum class Reads : std::uint8_t { Reports, Gaps, Before, First, Nothing };
  struct Running {
    pus::st129::Retrieve wanted;
    std::uint16_t destination{};
    std::uint64_t next{1};  ///< number of the record to go on with
    std::uint64_t through{0};  ///< and of the last one
    TimePoint begun{};
    bool reads{false};  ///< a page is under way
    Reads what{Reads::Reports};
    std::uint64_t seen{0};  ///< number of the newest record that was read, where all of them are
    std::uint64_t skipped{0};  ///< numbers between the records that were read
    std::vector<LogRecord> early{};  ///< gaps whose first record is older than what is asked for
    std::deque<LogRecord> page{};
    pus::st129::RetrievalEnd end{};
  };
  void take(Running& running, LogPage& page) const;
  static void look_for_skipped(Running& running, const LogRecord& record);
  void miss_what_was_before(Running& running, const LogPage& first) const;
  [[nodiscard]] LogQuery query_of(const Running& running) const;
  void read_on(Running& running, TimePoint now);
  void send(Running& running);
  void finish(std::string why);

  Parts parts_;
  std::optional<Running> running_;
  bool abandoned_{false};  ///< a page is under way that nobody wants any more
};

}  // namespace hirosco::supervisor
