// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/reception.hpp"

#include <fmt/format.h>

#include <utility>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"
#include "supervisor/supervision/data_handling/subscriptions.hpp"
#include "supervisor/supervision/event_handling/ground_loss.hpp"
#include "supervisor/supervision/event_handling/reactions.hpp"

namespace hirosco::supervisor {

namespace {

constexpr int messages_per_step = 256;
/// Fewer than its own engine and a subsystem work off in one step, with all their reports.
constexpr int ground_messages_per_step = 32;
constexpr Duration unreadable_period = 1s;
/// With so many under way the ground's next ones wait for a report instead of finding a full channel; but hardly for
/// addressees that stand still: SAFE_ALL may be behind them.
constexpr std::size_t most_unanswered = 128;
constexpr Duration unanswered_patience = 1ms;

/// Steps in a row in which the operating system refused to read a channel, before it counts as closed.
constexpr std::uint32_t most_refused = 3;
/// Of one message; everything else is of the channel.
bool is_damage(ErrorCode code) noexcept { return code == ErrorCode::Malformed || code == ErrorCode::Mismatch; }

}  // namespace

bool Reception::reads(const Member& member) const {
  if (parts_.succession.waits()) return false;
  if (!craft_.is_ground_link(member)) return true;
  const bool addressees_behind =
      parts_.unanswered.size() >= most_unanswered && craft_.now - answered_ < unanswered_patience;
  return !addressees_behind && parts_.telemetry.ground().takes_telecommands(craft_.now);
}

void Reception::read(Member& member) {
  MessageBuffer buffer;
  const int most = craft_.is_ground_link(member) ? ground_messages_per_step : messages_per_step;
  for (int left = most; left > 0 && member.alive() && reads(member); --left) {
    const auto found = member.channel()->receive(buffer);
    if (found) member.refused = 0;
    if (!found && found.error().code != ErrorCode::Unavailable) {
      // Damage is no loss: it is counted and told, and what follows is read.
      ++member.unreadable;
      member.why_unreadable = found.error();
      if (is_damage(found.error().code)) continue;
      // The system refuses: the next step tries again, but not for ever.
      if (++member.refused < most_refused) return;
    }
    if (!found) give_up(member);
    if (!found) return;
    if (found->flow == Flow::None) return;
    take(member, found->message);
  }
}

void Reception::give_up(Member& member) {
  if (member.closed_at) return;
  member.closed_at = craft_.now;
  craft_.guard.fence(member.apid());
  for (const std::uint16_t apid :
       parts_.reactions.fenced_by(member, descriptor::event_of_death, descriptor::Severity::High))
    craft_.guard.fence(apid);
}

void Reception::take(Member& member, const Message& message) {
  const std::uint16_t from = member.apid();
  if (message.kind == MessageKind::Event) {
    read_own();
    if (!parts_.reactions.take_event(from, message.packet)) return count_unreadable(from);
    parts_.ground_loss.hear_event(from, message.packet);
    parts_.subscriptions.hear_event(from, message.packet);
    return;
  }
  if (message.kind == MessageKind::PermitPage) return parts_.succession.confirmed(from);
  const auto header = pus::read_primary_header(message.packet);
  // Only the ground link brings what ground sent.
  const bool from_ground = message.kind == MessageKind::GroundTelecommand;
  if (!header || (from_ground && (!craft_.is_ground_link(member) || !header->telecommand))) {
    ++member.unreadable;
  } else if (!header->telecommand) {
    // Before an answer, what was said before it: the copy of the telecommand that it answers.
    read_own();
    const auto report = pus::TelemetryView::parse(message.packet);
    if (report && parts_.unanswered.contradicts(*report)) {
      craft_.tell(member.descriptor().name + " tells the end of a telecommand that was told as unknown", from);
      return parts_.stored.hear(from, *report);  // what it has changed is so all the same
    }
    if (!parts_.telemetry.take(from, message.packet)) count_unreadable(from);
  } else if (from_ground) {
    parts_.ground_loss.heard();
    parts_.telecommands.take(
        {.packet = message.packet, .origin = Origin::ground(message.link), .known_stop = message.epoch});
    craft_.remember();
    read_own();  // what it said about that: its own backlog must not overflow in a flood
  } else {
    parts_.telecommands.take(
        {.packet = message.packet, .origin = Origin::subsystem(from), .known_stop = message.epoch});
    craft_.remember();  // or its answer would be taken for one to nobody under the next supervisor
    read_own();
  }
}

void Reception::read_own() {
  MessageBuffer buffer;
  for (int left = messages_per_step; left > 0; --left) {
    const auto found = parts_.own.channel().receive(buffer);
    if (!found || found->flow == Flow::None) return;
    const Message& message = found->message;
    const bool event = message.kind == MessageKind::Event;
    const bool taken = event ? parts_.reactions.take_event(supervisor_apid, message.packet)
                             : parts_.telemetry.take(supervisor_apid, message.packet);
    if (!taken) count_unreadable(supervisor_apid);
    // Its housekeeping goes to who hears it with all telemetry; its events are none.
    if (taken && event) parts_.subscriptions.hear_event(supervisor_apid, message.packet);
  }
}

void Reception::hear(std::uint16_t, const pus::TelemetryView& report) {
  const std::size_t under_way = parts_.unanswered.size();
  parts_.unanswered.counted(report.apid(), report.sequence_count(), craft_.now);
  parts_.unanswered.reported(report);
  if (parts_.unanswered.size() < under_way) answered_ = craft_.now;
}

/// What is damaged or claims another sender is no loss: it is counted and told, and what follows is read (hazard SF9).
void Reception::count_unreadable(std::uint16_t from) {
  ++parts_.traffic.counts.misdirected;
  if (Member* origin = craft_.member(from)) ++origin->unreadable;
}

void Reception::tell_unreadable(Member& member) {
  if (member.unreadable == member.unreadable_told || craft_.now < member.next_unreadable_told) return;
  member.next_unreadable_told = craft_.now + unreadable_period;
  std::string line = fmt::format("{}: {} messages could not be read", member.descriptor().name,
                                 member.unreadable - std::exchange(member.unreadable_told, member.unreadable));
  // The count says enough of damage; who was built apart has to be told what to do.
  if (const Error& why = member.why_unreadable; why.code == ErrorCode::Mismatch)
    line += fmt::format(": {} ({})", why.text, why.value);
  craft_.tell(line, member.apid());
}

void Reception::tell_last_unreadable(Member& member) {
  member.next_unreadable_told = craft_.now;
  tell_unreadable(member);
}

}  // namespace hirosco::supervisor
