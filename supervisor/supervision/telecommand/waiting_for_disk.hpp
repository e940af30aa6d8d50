// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/supervision/telecommand/origin.hpp"

namespace hirosco::supervisor {

/// Telecommands that were permitted and leave when their record is on the disk, not before (decision 24): in the order in which
/// they came, bounded in number and time. It only keeps them: `Telecommands::take()` puts in what is not
/// essential, `Telecommands::forward_durable()` takes out what `PacketLog::durable()` says is on the disk and no fence has made void since.
/// Thread: the supervisor's.
class WaitingForDisk {
 public:
  /// A telecommand that is not durable after this time is refused: late execution surprises whoever gave it up.
  static constexpr Duration limit = std::chrono::seconds{15};
  static constexpr std::size_t most = 1024;

  struct Telecommand {
    std::uint64_t number{};  ///< of its record in the log
    std::uint16_t apid{};
    Origin origin;
    std::vector<std::byte> packet;
    MemoryHandle memory;
    pus::Request request;
    std::uint32_t mode_epoch{0};  ///< at permission; 0 = not bound to the mode
    TimePoint since{};
    bool releases_stop{false};
    std::uint64_t fences{0};  ///< of the addressee at permission
    bool starts{false};
  };

  [[nodiscard]] bool full() const noexcept { return waiting_.size() == most; }
  void add(Telecommand telecommand) { waiting_.push_back(std::move(telecommand)); }

  /// The oldest, when all up to its number are durable.
  [[nodiscard]] std::optional<Telecommand> take_durable(std::uint64_t durable);
  /// The oldest, when it has waited too long.
  [[nodiscard]] std::optional<Telecommand> take_late(TimePoint now);
  /// The oldest, whatever it waits for.
  [[nodiscard]] std::optional<Telecommand> take();

  [[nodiscard]] const std::deque<Telecommand>& all() const noexcept { return waiting_; }
  /// Since when the oldest waits; empty when none does.
  [[nodiscard]] std::optional<TimePoint> since() const;
  /// How many of this member's wait; 0: of the ground.
  [[nodiscard]] std::size_t count_of(std::uint16_t origin) const;

  // --- beyond this supervisor (docs/adr/0190) -----------------------------------------------------------------------
  /// Those up to this number of their record are about to leave. False: nobody but this supervisor would miss an end of one.
  [[nodiscard]] bool leave_up_to(std::uint64_t number);
  /// Those that wait, and those that are about to leave. Not the supervisor's own: nobody waits for their end.
  void note(OctetWriter& writer) const;
  /// \return with their addressees, those that were about to leave.
  [[nodiscard]] std::vector<std::pair<std::uint16_t, pus::Request>> recall(OctetReader& reader);
  /// Those that waited when the supervisor before died: none of them had left. They are forgotten.
  [[nodiscard]] std::vector<pus::Request> take_waited_before();

 private:
  std::deque<Telecommand> waiting_;
  std::uint64_t leaving_{0};  ///< up to this number they are about to leave
  std::vector<std::pair<std::uint16_t, pus::Request>> waited_before_;
};

}  // namespace hirosco::supervisor
