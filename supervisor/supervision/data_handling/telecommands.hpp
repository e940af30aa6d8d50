// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/ground_route.hpp"
#include "supervisor/supervision/data_handling/judgement.hpp"
#include "supervisor/supervision/data_handling/refusals.hpp"
#include "supervisor/supervision/data_handling/supervision_service.hpp"
#include "supervisor/supervision/data_handling/traffic.hpp"
#include "supervisor/supervision/data_handling/unanswered.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/telecommand/waiting_for_disk.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class CommandedMembers;
class PowerHandling;
class StoredValues;

/// A telecommand as it came in.
struct Incoming {
  Octets packet;
  Origin origin;
  MemoryHandle memory{};
  /// What its sender knows of the addressee, Guard::fences(): stopped since, and it is void. Empty: all that holds now.
  std::optional<std::uint64_t> free_at{};
  /// Guard::newest_stop() as its sender knew it before it was said, 0 = it does not know. Stopped since, it lets nobody move, sets nothing and
  /// changes no mode. Empty: the sender is this process.
  std::optional<std::uint32_t> known_stop{};
};

/// Permits or refuses, logs and forwards every telecommand (paper 4.3). One that is not essential leaves when it is on the
/// disk and not before (decision 24). What a part commands while one is taken is taken within that and not later: no more than three
/// within each other, in the order in which docs/adr/0226 has them in the log. Thread: the supervisor's.
class Telecommands final : public Watch, public Accounts, public Remembered {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    const Judgement& judgement;
    PowerHandling& power;
    Unanswered& unanswered;
    Traffic& traffic;
    GroundRoute& ground_route;
    CommandedMembers& commanded;
    StoredValues& stored;
    SupervisionService& supervision;
  };
  explicit Telecommands(const Parts& parts)
      : parts_{parts}, craft_{parts.craft}, refusals_{parts.craft, parts.own, parts.traffic} {}

  void take(const Incoming& incoming);
  /// What has become durable leaves.
  void forward_durable();
  /// What does not become durable in its time is refused.
  void watch(TimePoint now) override;
  void refuse_waiting() override;
  void outcome_unknown(std::uint16_t apid) override;
  /// Since when the oldest waits for the disk; empty when none does.
  [[nodiscard]] std::optional<TimePoint> waiting_since() const { return waiting_.since(); }

  /// What waits for the disk, what is about to leave and what is not answered yet.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;
  /// Of a supervisor that goes on for another: what that had begun and nobody ends any more is reported.
  void end_what_was_begun();

  /// An essential function of the supervisor that is carried out where it is received, by no cycle and no queue. Whoever
  /// carries it out reports on it.
  void at_once(std::string function, std::function<void(const pus::Request&)> carry_out) {
    at_once_.emplace(std::move(function), std::move(carry_out));
  }
  /// Who starts a subsystem that is down, or says why it could not.
  void starts_with(std::function<Result<>(std::uint16_t apid)> start) { start_ = std::move(start); }

 private:
  /// A permitted telecommand on its way to the addressee.
  struct Outgoing {
    std::uint16_t apid{};
    Origin origin;
    Octets packet;
    MemoryHandle memory;
    std::uint32_t mode_epoch{0};  ///< at permission; 0 = not bound to the mode
    bool essential{false};
    bool releases_stop{false};
    std::uint64_t fences{0};  ///< of the addressee at permission
  };
  [[nodiscard]] bool said_before_a_stop(const Incoming& incoming) const;
  [[nodiscard]] bool acts_in_another_situation(const Incoming& incoming, std::uint16_t apid) const;
  /// A subsystem that asks more than it may at once: the others' telecommands have their place.
  [[nodiscard]] std::optional<pus::FailureNotice> refuse_flood(const pus::TelecommandView& telecommand,
                                                               const Origin& origin, const Permitted& permitted);
  void refuse(const WaitingForDisk::Telecommand& waited, pus::FailureCode why);
  /// Why it did not leave; whoever asked refuses it. Empty: it has left, and the log says so.
  [[nodiscard]] std::optional<pus::FailureNotice> send(const Outgoing& outgoing);
  void log_forwarded(const Outgoing& outgoing);
  void start(const WaitingForDisk::Telecommand& waited);

  Parts parts_;
  Craft& craft_;
  Refusals refusals_;
  std::map<std::string, std::function<void(const pus::Request&)>, std::less<>> at_once_;
  std::function<Result<>(std::uint16_t)> start_;
  WaitingForDisk waiting_;
  struct Window {
    TimePoint begin{};
    std::size_t taken{0};
  };
  std::map<std::uint16_t, Window> asked_;  ///< of subsystems
};

/// For logs: the function with its first number, or the numbers of service and subtype.
[[nodiscard]] std::string telecommand_text(const pus::TelecommandView& telecommand);

}  // namespace hirosco::supervisor
