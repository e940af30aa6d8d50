// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/commands/request.hpp"
#include "ground/model/model.hpp"

namespace hirosco::ground {

/// Telecommands from their request to their last report, ours and those of others, and questions to the supervisor whether
/// one would be permitted. What becomes of each is in the archive before anybody hears of it.
class Commands {
 public:
  struct Parts {
    const Catalogue& catalogue;
    Archive& archive;
    const Model& model;
    const Clock& clock;
    /// On-board time now as far as the ground can tell.
    std::function<OnboardTime()> now;
    std::function<bool()> connected;
    /// False when it certainly does not leave. One that then could not leave after all comes back by not_sent().
    std::function<bool(Octets, Way)> send;
    /// Each stage of each command, as it is now.
    std::function<void(const StoredCommand&)> tell;
    std::uint16_t source{};  ///< of ours; our questions have question_source() of it
    std::uint16_t first_count{};
  };
  explicit Commands(Parts parts) : parts_{std::move(parts)}, count_{parts_.first_count} {}

  /// {subsystem, function, arguments, sender}; answers {id, apid, count, octets}.
  [[nodiscard]] Answered<nlohmann::json> send(const nlohmann::json& body);
  /// The same body: {octets, permitted, code, reason} through `done`, at the latest after 2 s.
  void preview(const nlohmann::json& body, std::function<void(Answered<nlohmann::json>)> done);
  /// {mode}: {mode, against, steps} through `done`, as the supervisor answers TC[129,4]; 503 at the latest after 2 s.
  void mode_preview(const nlohmann::json& body, std::function<void(Answered<nlohmann::json>)> done);
  /// A question of ST[129] to the supervisor, without reports on it; of the station, not of a client. Its request id; empty: it does not leave.
  [[nodiscard]] std::optional<std::uint32_t> ask(std::uint8_t subtype, Octets data);
  /// A telecommand that was to be sent has not left: its sender is told.
  void not_sent(Octets packet);
  /// What a packet said of telecommands.
  void hear(const Heard& heard, OnboardTime t);
  /// Limits of time.
  void expire(TimePoint now);

  /// For clients.
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

 private:
  struct Open {
    StoredCommand command;  ///< as its last report left it: pages hear of it even when the disk is full
    TimePoint since{};
  };
  struct Question {
    std::string octets;
    std::function<void(Answered<nlohmann::json>)> done;
    TimePoint since{};
  };
  struct ModeQuestion {
    std::uint8_t mode{};
    std::function<void(Answered<nlohmann::json>)> done;
    TimePoint since{};
  };
  [[nodiscard]] Answered<std::vector<std::byte>> packet_of(const Request& request, std::uint16_t count) const;
  void take_verdict(const Verdict& verdict, OnboardTime t);
  /// The copy of a telecommand of another ground, before the reports on it.
  void take_copy(Octets packet, OnboardTime t);
  /// A telecommand of another ground without a copy: known is whom it went to and what became of it.
  [[nodiscard]] Open add_foreign(const Verdict& verdict, OnboardTime t);
  void take_answer(const PermissionAnswer& answer);
  void take_answer(const ModeAnswer& answer);
  [[nodiscard]] std::uint16_t next_count();

  Parts parts_;
  std::map<std::pair<std::uint16_t, std::uint32_t>, Open> open_;  ///< by destination and request id
  std::multimap<std::uint32_t, Question> questions_;  ///< by the request id that is asked about
  std::vector<ModeQuestion> mode_questions_;
  std::uint16_t count_;
  std::uint64_t sent_{0};
};

}  // namespace hirosco::ground
