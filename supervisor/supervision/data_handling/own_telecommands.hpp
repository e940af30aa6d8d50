// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/data_handling/telecommands.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// The supervisor's own telecommands: they take the way of all others, and whoever sent one hears how it ended.
/// Thread: the supervisor's.
class OwnTelecommands final : public CommandDesk, public Hearer, public Watch {
 public:
  OwnTelecommands(Craft& craft, Telecommands& telecommands, std::uint16_t first_sequence_count)
      : craft_{craft}, telecommands_{telecommands}, next_sequence_count_{first_sequence_count} {}

  using CommandDesk::command;
  void command(std::uint16_t apid, std::string_view function, std::optional<double> argument, CommandDone done,
               std::optional<std::uint64_t> free_at) override;
  void send(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data, const MemoryHandle& memory,
            CommandDone done, Duration takes) override;
  /// Who has died answers nothing any more: what waits for it goes on at once.
  void fail_all_to(std::uint16_t apid, const std::string& why);
  /// Service 1 reports on them.
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  /// Those that nobody answers, or that take longer than they may.
  void watch(TimePoint now) override;

 private:
  struct Sent {
    CommandDone done;
    TimePoint deadline{};
    std::string what;
    std::uint16_t apid{};
    Duration takes{0};
    bool begun{false};  ///< of what takes its time
    /// Its addressee is there, and at it.
    void begins();
    /// Why it is given up.
    [[nodiscard]] std::string why() const;
  };
  struct Packet {
    std::uint16_t apid{};
    std::uint8_t service{}, subtype{};
    Octets data;
    MemoryHandle memory{};
    std::optional<std::uint64_t> free_at{};
  };
  void send(const Packet& what, CommandDone done, Duration takes);

  Craft& craft_;
  Telecommands& telecommands_;
  std::map<std::uint32_t, Sent> sent_;  ///< by request id
  std::uint16_t next_sequence_count_;
};

}  // namespace hirosco::supervisor
