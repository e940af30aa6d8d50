// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/telecommands.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/subsystem/service_loop/requester.hpp"
#include "supervisor/supervision/commanded_members.hpp"
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"
#include "supervisor/supervision/data_handling/telecommand_copy.hpp"
#include "supervisor/supervision/resource_management/power_handling.hpp"
#include "supervisor/supervision/telecommand/called_function.hpp"

namespace hirosco::supervisor {
namespace {

using pus::FailureCode;
using pus::FailureNotice;

}  // namespace

std::string telecommand_text(const pus::TelecommandView& telecommand) {
  if (const auto call = called_function(telecommand)) {
    if (call->first_argument) return fmt::format("{} {}", call->name, *call->first_argument);
    return std::string{call->name};
  }
  return fmt::format(FMT_COMPILE("TC[{},{}]"), telecommand.service(), telecommand.subtype());
}

void Telecommands::take(const Incoming& incoming) {
  ++parts_.traffic.counts.telecommands;
  const auto telecommand = pus::TelecommandView::parse(incoming.packet);
  if (!telecommand) return refusals_.refuse_damaged(incoming.packet, incoming.origin, telecommand.error());
  pus::Request request = pus::request_of(*telecommand);
  // Reports to a claimed id would end somebody else's requests.
  const bool foreign = !incoming.origin.owns(request.source, craft_.mission);
  if (foreign) request = {request.id, incoming.origin.apid(), 0};
  const std::uint16_t apid = telecommand->apid();
  const bool asks_only = apid == supervisor_apid && telecommand->service() == pus::st129::service_type;
  const auto copy_to_ground = [&] {
    if (incoming.origin.is_ground() && !asks_only) send_telecommand_copy(parts_.own.telemetry(), incoming.packet);
  };
  // What it reads decides over functions alone; of those a question may ask, too.
  if (asks_only || telecommand->service() == pus::FunctionService::service_type) parts_.power.observe();
  // Before the number: whoever is stopped in between is not let go by this one.
  const std::uint64_t fences = incoming.free_at.value_or(craft_.guard.fences(apid));
  auto decision = parts_.judgement.judge(*telecommand, incoming.origin);
  if (decision && said_before_a_stop(incoming) && !decision->essential &&
      (decision->releases_stop || decision->starts || (decision->acts && acts_in_another_situation(incoming, apid)))) {
    FailureNotice notice{FailureCode::NotPermittedNow};
    decision = std::unexpected{
        notice.because({ErrorCode::NotPermitted, 0, "it may have been said before the stop: say it again"})};
  }
  if (decision)
    if (const auto flood = refuse_flood(*telecommand, incoming.origin, *decision)) decision = std::unexpected{*flood};
  if (!decision) {
    copy_to_ground();
    if (decision.error().code() == FailureCode::PowerShort) parts_.power.tell_shortage(apid, decision.error());
    return refusals_.refuse(incoming.packet, incoming.origin, request, decision.error());
  }
  if (decision->reserves_w > 0)
    parts_.power.ledger().reserve(apid, decision->reserves_w, request, craft_.now + WaitingForDisk::limit);
  if (asks_only) {
    static_cast<void>(craft_.log.append({.kind = LogKind::TelecommandReceived,
                                         .source = incoming.origin.apid(),
                                         .peer = apid,
                                         .packet = incoming.packet,
                                         .note = "a question"}));
    return parts_.supervision.handle(*telecommand, request);
  }
  std::string text = telecommand_text(*telecommand);
  if (foreign) {
    // What is carried out all the same is reported to who said it, and is told.
    request.ack = telecommand->ack();
    text += fmt::format(" under the source id {}, which is somebody else's", telecommand->source());
  }
  LogEntry received{.kind = LogKind::TelecommandReceived,
                    .source = incoming.origin.apid(),
                    .peer = apid,
                    .packet = incoming.packet,
                    .note = std::string_view{text}};
  // Nobody could command anything until the ground link is back, or this supervisor itself where it goes on for another one: neither
  // waits for a disk.
  const Member* addressee = craft_.member(apid);
  const bool is_awaited = addressee != nullptr ? craft_.restoring_ground_link && craft_.is_ground_link(*addressee)
                                               : craft_.taking_over && apid == supervisor_apid;
  const bool restores = incoming.origin.is_supervisor() && is_awaited;
  if (decision->essential || restores) {
    const auto call = called_function(*telecommand);
    const auto own = apid == supervisor_apid && call ? at_once_.find(call->name) : at_once_.end();
    const bool here = own != at_once_.end();
    if (here) copy_to_ground();  // before it says anything of itself
    std::optional<FailureNotice> unsent;
    if (here) own->second(request);
    else
      unsent = send({apid, incoming.origin, incoming.packet, incoming.memory, 0, true,
                     restores && decision->releases_stop, fences});
    if (foreign) craft_.tell(text, incoming.origin.apid());
    if (!here) copy_to_ground();
    received.may_wait = !here;  // it has left, or could not
    static_cast<void>(craft_.log.append(received));
    // Behind that it came in: its end is the last that log and ground hear of it.
    if (unsent) refusals_.refuse(incoming.packet, incoming.origin, request, *unsent);
    return;
  }
  copy_to_ground();
  const std::uint64_t number = craft_.log.append(received);
  if (number == 0 || waiting_.full())
    return refusals_.refuse(incoming.packet, incoming.origin, request, FailureNotice{FailureCode::QueueFull});
  // Its own telecommands were not permitted by the mode, so a change of mode does not void them.
  const std::uint32_t mode_epoch = incoming.origin.is_supervisor() ? 0 : craft_.mode_epoch;
  waiting_.add({number,
                apid,
                incoming.origin,
                {incoming.packet.begin(), incoming.packet.end()},
                incoming.memory,
                request,
                mode_epoch,
                craft_.now,
                decision->releases_stop,
                fences,
                decision->starts});
  forward_durable();
}

/// Where nothing was stopped yet nothing can have been said before it.
bool Telecommands::said_before_a_stop(const Incoming& incoming) const {
  const std::uint32_t newest = craft_.guard.newest_stop();
  return incoming.known_stop && *incoming.known_stop != newest && newest != Guard::no_stop_yet;
}

/// A motion from before would be carried out when somebody else has let its member go. Who was not stopped goes on, and hears all.
bool Telecommands::acts_in_another_situation(const Incoming& incoming, std::uint16_t apid) const {
  return apid == supervisor_apid || craft_.guard.was_stopped_since(apid, *incoming.known_stop);
}

/// Stopping the craft is no request of another one, and never too much; nor is a question, which waits for nothing.
std::optional<FailureNotice> Telecommands::refuse_flood(const pus::TelecommandView& telecommand, const Origin& origin,
                                                        const Permitted& permitted) {
  const bool asks_only = telecommand.apid() == supervisor_apid && telecommand.service() == pus::st129::service_type;
  if (!origin.is_subsystem() || permitted.stops_the_craft || asks_only) return std::nullopt;
  // What nobody waits for would not be known to be under way.
  if ((telecommand.ack() & pus::ack_completion) == 0) return FailureNotice{FailureCode::IllegalField};
  const std::size_t under_way =
      parts_.unanswered.count_of(origin.apid(), craft_.now) + waiting_.count_of(origin.apid());
  Window& window = asked_[origin.apid()];
  if (craft_.now - window.begin >= 1s) window = {.begin = craft_.now};
  // What protects does not wait for the end of others.
  const bool too_many = under_way >= Requester::most_open && !permitted.essential;
  if (too_many || window.taken == Requester::most_a_second) return FailureNotice{FailureCode::QueueFull};
  ++window.taken;
  return std::nullopt;
}

void Telecommands::forward_durable() {
  const std::uint64_t durable = craft_.log.durable();
  // Before the first of them is sent, and once for all: whoever goes on must not refuse what its addressee carries out (docs/adr/0190).
  const bool somebodys = waiting_.leave_up_to(durable);
  if (somebodys) craft_.remember();
  while (const auto next = waiting_.take_durable(durable)) {
    // What was permitted before a fence is void after it: it was permitted for another situation (hazard SF4).
    if (craft_.guard.fences(next->apid) != next->fences) {
      refuse(*next, FailureCode::NotPermittedNow);
      continue;
    }
    // Nor does anybody begin to move by what held when it was said: a link may have gone since, or a state.
    bool releases_stop = false;
    if (next->releases_stop) {
      const auto decision = parts_.judgement.judge(*pus::TelecommandView::parse(next->packet),
                                                   next->origin);  // it was parsed when it came
      if (!decision) {
        refusals_.refuse(next->packet, next->origin, next->request, decision.error());
        continue;
      }
      releases_stop = decision->releases_stop;
    }
    if (next->starts) {
      start(*next);
      continue;
    }
    const auto unsent = send(
        {next->apid, next->origin, next->packet, next->memory, next->mode_epoch, false, releases_stop, next->fences});
    if (unsent) refusals_.refuse(next->packet, next->origin, next->request, *unsent);
  }
  if (somebodys) craft_.remember();  // that they have left, and what they set and command
}

void Telecommands::watch(TimePoint now) {
  while (const auto late = waiting_.take_late(now)) refuse(*late, FailureCode::QueueFull);
  for (const pus::Request& request : parts_.unanswered.take_doubtful(now))
    parts_.own.verification().completion_failed(request, FailureNotice{FailureCode::OutcomeUnknown});
}

void Telecommands::refuse_waiting() {
  while (const auto each = waiting_.take()) refuse(*each, FailureCode::NotPermittedNow);
}

void Telecommands::outcome_unknown(std::uint16_t apid) {
  for (const pus::Request& request : parts_.unanswered.take(apid))
    parts_.own.verification().completion_failed(request, FailureNotice{FailureCode::OutcomeUnknown});
}

void Telecommands::note(OctetWriter& writer) const {
  parts_.unanswered.note(writer);
  waiting_.note(writer);
}

void Telecommands::recall(OctetReader& reader) {
  parts_.unanswered.recall(reader);
  for (const auto& [apid, request] : waiting_.recall(reader)) parts_.unanswered.was_leaving(apid, request);
}

/// What had not left is void: it was permitted by somebody else, in a situation that has passed. Of what was leaving its addressee says
/// whether it had.
void Telecommands::end_what_was_begun() {
  pus::Verification& verification = parts_.own.verification();
  for (const pus::Request& request : waiting_.take_waited_before())
    verification.rejected(request, FailureNotice{FailureCode::NotPermittedNow});
  parts_.unanswered.hears_from(craft_.now);
  for (const pus::Request& request : parts_.unanswered.take_settled())
    verification.completion_failed(request, FailureNotice{FailureCode::OutcomeUnknown});
  outcome_unknown(supervisor_apid);
  for (const Member& member : craft_.members)
    if (!member.alive()) outcome_unknown(member.apid());
}

void Telecommands::refuse(const WaitingForDisk::Telecommand& waited, FailureCode why) {
  refusals_.refuse(waited.packet, waited.origin, waited.request, FailureNotice{why});
}

/// The supervisor ends it, as who is addressed cannot hear it; a plan that was quicker has done what it asks for.
void Telecommands::start(const WaitingForDisk::Telecommand& waited) {
  if (waited.mode_epoch != craft_.mode_epoch) return refuse(waited, FailureCode::NotPermittedNow);
  // Its end is known to be owed until it has left for the ground.
  if (const auto telecommand = pus::TelecommandView::parse(waited.packet))
    parts_.unanswered.forwarded(supervisor_apid, *telecommand, craft_.now);
  pus::Verification& verification = parts_.own.verification();
  verification.accepted(waited.request);
  verification.started(waited.request);
  parts_.commanded.overrule(waited.apid);
  const Result<> started =
      start_ ? start_(waited.apid) : fail(ErrorCode::Unavailable, "its process could not be started");
  if (started) return verification.completed(waited.request);
  const Error& why = started.error();
  FailureNotice notice{FailureCode::ExecutionError};
  verification.completion_failed(waited.request, notice.because({why.code, why.value, why.text}));
}

std::optional<FailureNotice> Telecommands::send(const Outgoing& outgoing) {
  const auto& [apid, origin, packet, memory, mode_epoch, essential, releases_stop, fences] = outgoing;
  const bool to_itself = apid == supervisor_apid;
  // Its end could not be told when its addressee dies. What protects leaves all the same: then only its own report tells of it.
  if (parts_.unanswered.full() && !essential && !to_itself) return FailureNotice{FailureCode::QueueFull};
  // The stop is lifted by exactly this telecommand, when it leaves.
  if (releases_stop && !to_itself && !craft_.guard.release(apid, fences)) {
    FailureNotice notice{FailureCode::NotPermittedNow};
    return notice.because({ErrorCode::NotPermitted, 0, "stopped since this was asked for, or stopping"});
  }
  Member* addressee = craft_.member(apid);
  if (releases_stop && addressee != nullptr) addressee->fences_when_free = fences;
  Channel* channel = to_itself ? &parts_.own.channel() : addressee != nullptr ? addressee->channel() : nullptr;
  // The ground hears what was said before this telecommand in the state in which it was said.
  if (addressee != nullptr && channel != nullptr && craft_.is_ground_link(*addressee))
    parts_.ground_route.flush(*channel, craft_.now);
  const Message message{.kind = MessageKind::Packet, .epoch = mode_epoch, .packet = packet, .memory = memory};
  // A recovery does not fail because its member has much to read (hazard R5).
  const bool surely = essential && origin.is_supervisor() && !releases_stop && !to_itself;
  const bool sent =
      channel != nullptr &&
      (surely ? addressee->channel()->send_or_keep(message, craft_.now) : channel->send(message)).has_value();
  if (!sent) {
    // The permission was for this one: an older one that stands unread must not find it (hazard SF4).
    if (releases_stop && !to_itself) craft_.guard.fence(apid);
    return channel == nullptr ? is_down() : FailureNotice{FailureCode::QueueFull};
  }
  if (const auto telecommand = pus::TelecommandView::parse(packet)) {
    parts_.unanswered.forwarded(apid, *telecommand, craft_.now);
    parts_.commanded.forwarded(apid, *telecommand, origin);
    if (!to_itself) parts_.stored.forwarded(apid, *telecommand);
  }
  log_forwarded(outgoing);
  return std::nullopt;
}

void Telecommands::log_forwarded(const Outgoing& outgoing) {
  constexpr bool may_wait = true;  // its note is in the journal, and nobody waits for this record
  static_cast<void>(craft_.log.append({LogKind::TelecommandForwarded, supervisor_apid, outgoing.apid, outgoing.packet,
                                       outgoing.essential ? "essential" : "", may_wait}));
}

}  // namespace hirosco::supervisor
