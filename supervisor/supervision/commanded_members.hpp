// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "supervisor/supervision/commanded_state.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/telecommand/origin.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// What each member was commanded to be (docs/adr/0076). What leads up counts when its TM[1,7] has come by, what leads down as soon as
/// it is sent or a plan, or a stop, asks for it. Nothing is kept in a mission without a plan that brings anybody back, but of the
/// supervisor itself, whom no stop and no plan lowers: whoever goes on for it is set as it was (docs/adr/0205).
/// Bounded: `most_open` telecommands whose end is awaited, `most_open_octets` of them, and per member what CommandedState says; what has no room is told,
/// COMMAND_NOT_KEPT. Thread: the supervisor's.
class CommandedMembers final : public Hearer, public Remembered {
 public:
  static constexpr std::size_t most_open = 256;
  /// Less than the journal has room for by far.
  static constexpr std::size_t most_open_octets = std::size_t{128} << 10;
  /// The partner of a link may see its loss before the supervisor sees the death that it comes from.
  static constexpr Duration loss_before_death = std::chrono::seconds{1};

  CommandedMembers(Craft& craft, OwnSubsystem& own) : craft_{craft}, own_{own} {}

  /// Some plan of the mission brings back who crashed.
  [[nodiscard]] bool in_use() const;
  /// It has left for a member, or for the supervisor itself.
  void forwarded(std::uint16_t apid, const pus::TelecommandView& telecommand, const Origin& origin);
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  /// A plan takes it down, or makes it safe, because of this event; whatever was under way to bring it up counts no more.
  void lower(std::uint16_t apid, State most, std::string_view event);
  /// Nobody who may move anything goes beyond Safe-Operational until it is commanded to anew.
  void all_stopped();
  /// Its process is gone: it is Offline, and its settings went with it.
  void ended(std::uint16_t apid);

  /// What each was commanded to be, and what is awaited. Who was being brought back is not. Events that the supervisor itself does not
  /// report are silent from the recall on.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

  /// What the supervisor before this one was set to is known, and this one is not so yet.
  [[nodiscard]] bool owes_own_settings() const noexcept { return own_before_.has_value(); }
  /// What brings that back in this state, and behind it what had left for the supervisor and was not ended when it died: whether it
  /// was done nobody knows, and what was refused is refused again. In the order in which they are to be sent.
  [[nodiscard]] std::vector<SettingCommand> own_settings(State in) const;
  /// It is as it was set: from now on what this one completes is noted.
  void own_settings_are_back() { own_before_.reset(); }
  /// The supervisor itself is not as it was set: one that was refused, or all, of which nothing is known.
  void tell_own_not_kept(const SettingCommand& command);
  void tell_own_lost();

  [[nodiscard]] CommandedState of(std::uint16_t apid) const;
  /// The same for the partner of who is gone: a stale link that it told of just now was the beginning of that.
  [[nodiscard]] CommandedState of_partner(std::uint16_t apid) const;

  /// It is to be brought back to this.
  void want(std::uint16_t apid, CommandedState wanted) { wanted_.insert_or_assign(apid, std::move(wanted)); }
  [[nodiscard]] const std::map<std::uint16_t, CommandedState>& wanted() const noexcept { return wanted_; }
  /// Null: nothing is wanted of it.
  [[nodiscard]] const CommandedState* wanted(std::uint16_t apid) const;
  void forget_wanted() {
    wanted_.clear();
    overruled_.reset();
  }
  /// Somebody else has commanded one of them since: its word counts.
  [[nodiscard]] std::optional<std::uint16_t> overruled() const noexcept { return overruled_; }
  void overrule(std::uint16_t apid) {
    if (wanted_.contains(apid)) overruled_ = apid;
  }

 private:
  struct Member {
    CommandedState commanded;
    std::optional<CommandedState> before_loss;  ///< of a link, of which it told at `loss_at`
    TimePoint loss_at{};
  };
  struct Open {
    std::uint16_t apid{};
    pus::Request request;
    std::vector<std::byte> packet;
    unsigned refused{0};  ///< of its instructions
  };
  /// Of the supervisor before this one.
  struct OwnBefore {
    CommandedState commanded;
    std::deque<Open> open;
  };
  /// Of what this one has sent itself nobody after it waits for an end.
  [[nodiscard]] static bool is_handed_on(const Open& each) noexcept {
    return each.apid != supervisor_apid || each.request.source != supervisor_apid;
  }
  void take_own_before();
  void lower_record(std::uint16_t apid, State most);
  [[nodiscard]] bool has_room_for(std::size_t octets) const;
  [[nodiscard]] bool is_just_now(const Member& member) const;
  void tell_not_kept(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype);

  Craft& craft_;
  OwnSubsystem& own_;
  std::map<std::uint16_t, Member> members_;
  std::deque<Open> open_;
  std::optional<OwnBefore> own_before_;
  std::map<std::uint16_t, CommandedState> wanted_;
  std::optional<std::uint16_t> overruled_;
};

}  // namespace hirosco::supervisor
