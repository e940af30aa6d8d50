// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/telecommands.hpp"
#include "supervisor/supervision/data_handling/telemetry.hpp"
#include "supervisor/supervision/data_handling/unanswered.hpp"
#include "supervisor/supervision/succession/succession.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class GroundLoss;
class Reactions;
class StoredValues;
class Subscriptions;

/// Reads what the members and the supervisor itself say, and hands it on by its kind. The ground is read no faster than its
/// telecommands are answered (adr 0029). Thread: the supervisor's.
class Reception final : public Hearer {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    Telecommands& telecommands;
    Telemetry& telemetry;
    Reactions& reactions;
    GroundLoss& ground_loss;
    Unanswered& unanswered;
    Traffic& traffic;
    Subscriptions& subscriptions;
    StoredValues& stored;
    Succession& succession;
  };
  explicit Reception(const Parts& parts) : parts_{parts}, craft_{parts.craft} {}

  void read(Member& member);
  /// The supervisor's own end: what it said comes before what others say after it.
  void read_own();
  /// False while what a member sends has to wait: its channel is not to wake anybody.
  [[nodiscard]] bool reads(const Member& member) const;
  /// How many messages of a member could not be read: the first at once, then once a second.
  void tell_unreadable(Member& member);
  /// The same for one that has ended, at once.
  void tell_last_unreadable(Member& member);
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  /// Whoever can be neither commanded nor heard, or has ended as the system says, moves nothing any more; nor do those whom its death,
  /// which comes within a second, stops.
  void give_up(Member& member);

 private:
  void take(Member& member, const Message& message);
  void count_unreadable(std::uint16_t from);

  Parts parts_;
  Craft& craft_;
  TimePoint answered_{};  ///< when a telecommand under way was answered last
};

}  // namespace hirosco::supervisor
