// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/supervision/telecommand/waiting_for_disk.hpp"

namespace hirosco::supervisor {

/// Told once how a telecommand ended.
using CommandDone = std::function<void(bool success, const std::string& why)>;

/// Sends the supervisor's own telecommands through permit, route and log.
class CommandDesk {
 public:
  /// For what is done at once; what takes longer has to say by then that it has begun. Generous: a slow disk alone may hold
  /// a telecommand back for seconds (decision 24). No less than it may wait for the disk, so that none is executed after it
  /// was reported as failed.
  static constexpr Duration answer_limit = WaitingForDisk::limit;

  virtual ~CommandDesk() = default;
  /// A function, by its name.
  void command(std::uint16_t apid, std::string_view function, std::optional<double> argument, CommandDone done) {
    command(apid, function, argument, std::move(done), std::nullopt);
  }
  /// The same, by who was told to before: void once the addressee was stopped since (`free_at`: Guard::fences() of then).
  virtual void command(std::uint16_t apid, std::string_view function, std::optional<double> argument, CommandDone done,
                       std::optional<std::uint64_t> free_at) = 0;
  /// Any other request; memory travels beside it. `takes`: how much longer than `answer_limit` its completion may be out,
  /// once its addressee has said that it has begun (docs/adr/0206).
  virtual void send(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
                    const MemoryHandle& memory, CommandDone done, Duration takes) = 0;
};

}  // namespace hirosco::supervisor
