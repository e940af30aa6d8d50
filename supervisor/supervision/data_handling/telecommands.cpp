// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/telecommands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hirosco/pus/st129_supervision/supervision.hpp"
#include "supervisor/supervision/data_handling/telecommand_copy.hpp"
#include "supervisor/supervision/resource_management/power_handling.hpp"

namespace hirosco::supervisor {
namespace {

using pus::FailureCode;
using pus::FailureNotice;

/// Reports on damaged packets in one second (pus-c tailoring 5.3).
constexpr int damaged_reports_per_second = 10;
constexpr std::size_t most_waiting = 1024;

/// The supervisor's own source id is nobody else's: reports to a forged one would end its own requests.
[[nodiscard]] bool forged(const pus::Request& request, Sender sender) {
  return sender != Sender::Supervisor && request.source == supervisor_apid;
}

}  // namespace

std::string telecommand_text(const pus::TelecommandView& telecommand) {
  if (const auto call = called_function(telecommand)) {
    if (call->first_argument) return fmt::format("{} {}", call->name, *call->first_argument);
    return std::string{call->name};
  }
  return fmt::format("TC[{},{}]", telecommand.service(), telecommand.subtype());
}

void Telecommands::take(const Incoming& incoming) {
  ++parts_.traffic.counts.telecommands;
  const auto telecommand = pus::TelecommandView::parse(incoming.packet);
  if (!telecommand) return take_damaged(incoming, telecommand.error());
  pus::Request request = pus::request_of(*telecommand);
  if (forged(request, incoming.sender)) request = {request.id, 0, 0};
  const std::uint16_t apid = telecommand->apid();
  const bool asks_only = apid == supervisor_apid && telecommand->service() == pus::st129::service_type;
  const auto copy_to_ground = [&] {
    if (incoming.sender == Sender::Ground && !asks_only) send_telecommand_copy(parts_.own.telemetry(), incoming.packet);
  };
  parts_.power.observe();
  const auto decision = judge(*telecommand, incoming.sender);
  if (!decision) {
    copy_to_ground();
    if (decision.error().code() == FailureCode::PowerShort) parts_.power.tell_shortage(apid, decision.error());
    return reject(incoming, request, decision.error());
  }
  if (decision->reserves_w > 0)
    parts_.power.ledger().reserve(apid, decision->reserves_w, request, craft_.now + durable_limit);
  if (asks_only) return answer_question(incoming, *telecommand);
  const std::string text = telecommand_text(*telecommand);
  const LogEntry received{.kind = LogKind::TelecommandReceived,
                          .source = incoming.source,
                          .peer = apid,
                          .packet = incoming.packet,
                          .note = std::string_view{text}};
  const std::uint64_t fences = craft_.guard.fences(apid);
  // Nobody could command anything until the ground link is back: its own restoration waits for no disk either.
  const Member* addressee = craft_.member(apid);
  const bool restores = incoming.sender == Sender::Supervisor && craft_.restoring_ground_link && addressee != nullptr &&
                        craft_.is_ground_link(*addressee);
  if (decision->essential || restores) {
    const auto call = called_function(*telecommand);
    const auto own = apid == supervisor_apid && call ? at_once_.find(call->name) : at_once_.end();
    if (own != at_once_.end()) own->second(request);
    else
      forward({apid, incoming.packet, incoming.memory, request, 0, true, restores && decision->releases_stop, fences});
    copy_to_ground();
    static_cast<void>(craft_.log.append(received));
    return;
  }
  copy_to_ground();
  const std::uint64_t number = craft_.log.append(received);
  if (number == 0 || waiting_.size() == most_waiting)
    return reject(incoming, request, FailureNotice{FailureCode::QueueFull});
  // Its own telecommands were not permitted by the mode, so a change of mode does not void them.
  const std::uint32_t mode_epoch = incoming.sender == Sender::Supervisor ? 0 : craft_.mode_epoch;
  waiting_.push_back({number,
                      apid,
                      {incoming.packet.begin(), incoming.packet.end()},
                      incoming.memory,
                      request,
                      mode_epoch,
                      craft_.now,
                      decision->releases_stop,
                      fences});
  forward_durable();
}

void Telecommands::take_damaged(const Incoming& incoming, const FailureNotice& notice) {
  const auto header = pus::read_primary_header(incoming.packet);
  if (header && header->apid == pus::idle_apid) return;  // idle packets are dropped silently
  const std::uint32_t request_id = header ? header->request_id : 0;
  if (craft_.now - report_window_ >= 1s) {
    report_window_ = craft_.now;
    reports_in_window_ = 0;
  }
  ++reports_in_window_;
  reject(incoming, {request_id, 0, 0}, notice);
}

/// All that may refuse a well-formed telecommand, without doing anything about it: what is asked before sending and what
/// is decided on sending are this one function.
std::expected<Permitted, FailureNotice> Telecommands::judge(const pus::TelecommandView& telecommand,
                                                            Sender sender) const {
  if (forged(pus::request_of(telecommand), sender)) return std::unexpected{FailureNotice{FailureCode::IllegalField}};
  const auto decision = decide(telecommand, sender, situation_of(telecommand.apid()));
  if (!decision || !decision->releases_stop) return decision;
  // What a recovery has stopped is not released by a command that crosses it.
  if (const Member* addressee = std::as_const(craft_).member(telecommand.apid());
      addressee != nullptr && addressee->recovering)
    return std::unexpected{FailureNotice{FailureCode::WrongState}};
  return decision;
}

Situation Telecommands::situation_of(std::uint16_t apid) const {
  Situation situation{.mission = craft_.mission,
                      .mode = *craft_.mode,
                      .links = parts_.links,
                      .state = std::nullopt,
                      .power = &parts_.power.ledger()};
  if (apid == supervisor_apid) {
    situation.state = parts_.own.state();
    situation.configuration = parts_.own.configuration();
    return situation;
  }
  const Member* addressee = std::as_const(craft_).member(apid);
  if (addressee == nullptr || !addressee->alive()) return situation;
  situation.state = addressee->state();
  situation.configuration = addressee->configuration();
  return situation;
}

/// TC[129,1]: nothing is done but answered. Whoever asks is judged as the sender that it is.
void Telecommands::answer_question(const Incoming& incoming, const pus::TelecommandView& question) {
  const pus::Request request = pus::request_of(question);
  const Octets asked = question.application_data();
  const auto header = pus::read_primary_header(asked);
  if (!header) return reject(incoming, request, FailureNotice{FailureCode::DataLength});
  static_cast<void>(craft_.log.append({.kind = LogKind::TelecommandReceived,
                                       .source = incoming.source,
                                       .peer = supervisor_apid,
                                       .packet = incoming.packet,
                                       .note = "is it permitted?"}));
  parts_.own.verification().accepted(request);
  parts_.own.verification().started(request);
  const auto telecommand = pus::TelecommandView::parse(asked);
  const auto decision = telecommand ? judge(*telecommand, incoming.sender) : std::unexpected{telecommand.error()};
  std::array<std::byte, 7> data;
  OctetWriter writer{data};
  writer.put(header->request_id);
  writer.put(static_cast<std::uint8_t>(decision ? 1 : 0));
  writer.put(static_cast<std::uint16_t>(decision ? 0 : static_cast<std::uint16_t>(decision.error().code())));
  parts_.own.telemetry().report(pus::st129::service_type, pus::st129::permission_answer, request.source, data);
  parts_.own.verification().completed(request);
}

void Telecommands::forward_durable() {
  while (!waiting_.empty() && waiting_.front().number <= craft_.log.durable()) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    // What was permitted before a fence is void after it: it was permitted for another situation (findings SF4).
    if (craft_.guard.fences(next.apid) != next.fences) {
      reject({.packet = next.packet, .memory = {}}, next.request, FailureNotice{FailureCode::NotPermittedNow});
      continue;
    }
    forward(
        {next.apid, next.packet, next.memory, next.request, next.mode_epoch, false, next.releases_stop, next.fences});
  }
}

std::optional<TimePoint> Telecommands::waiting_since() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.front().since;
}

void Telecommands::watch(TimePoint now) {
  while (!waiting_.empty() && now - waiting_.front().since >= durable_limit) refuse_oldest(FailureCode::QueueFull);
}

void Telecommands::refuse_waiting() {
  while (!waiting_.empty()) refuse_oldest(FailureCode::NotPermittedNow);
}

void Telecommands::outcome_unknown(std::uint16_t apid) {
  for (const pus::Request& request : parts_.outstanding.take(apid))
    parts_.own.verification().completion_failed(request, FailureNotice{FailureCode::OutcomeUnknown});
}

void Telecommands::refuse_oldest(FailureCode why) {
  const Waiting oldest = std::move(waiting_.front());
  waiting_.pop_front();
  reject({.packet = oldest.packet, .memory = {}}, oldest.request, FailureNotice{why});
}

void Telecommands::forward(const Outgoing& outgoing) {
  const auto& [apid, packet, memory, request, mode_epoch, essential, releases_stop, fences] = outgoing;
  const bool to_itself = apid == supervisor_apid;
  // The stop is lifted by exactly this telecommand, when it leaves.
  if (releases_stop && !to_itself && !craft_.guard.release(apid, fences))
    return reject({.packet = packet, .memory = {}}, request, FailureNotice{FailureCode::NotPermittedNow});
  Member* addressee = craft_.member(apid);
  Channel* channel = to_itself ? &parts_.own.channel() : addressee != nullptr ? addressee->channel() : nullptr;
  const Message message{.kind = MessageKind::Packet, .mode_epoch = mode_epoch, .packet = packet, .memory = memory};
  const bool sent = channel != nullptr && channel->send(message).has_value();
  if (!sent) {
    const auto code = channel == nullptr ? FailureCode::UnknownApid : FailureCode::QueueFull;
    return reject({.packet = packet, .memory = {}}, request, FailureNotice{code});
  }
  if (const auto telecommand = pus::TelecommandView::parse(packet); !to_itself && telecommand)
    parts_.outstanding.forwarded(apid, *telecommand);
  static_cast<void>(craft_.log.append({.kind = LogKind::TelecommandForwarded,
                                       .source = supervisor_apid,
                                       .peer = apid,
                                       .packet = packet,
                                       .note = essential ? "essential" : ""}));
}

void Telecommands::reject(const Incoming& incoming, const pus::Request& request, const FailureNotice& notice) {
  const bool damaged = notice.code() == FailureCode::ErrorControl || notice.code() == FailureCode::IllegalLength ||
                       notice.code() == FailureCode::IllegalPrimaryHeader ||
                       notice.code() == FailureCode::IllegalSequenceFlags;
  // Beyond the cap they are counted only: a flood of them must not fill the log's queue before honest telecommands.
  if (damaged && reports_in_window_ > damaged_reports_per_second) return parts_.traffic.count_rejection(notice.code());
  const auto header = pus::read_primary_header(incoming.packet);
  static_cast<void>(craft_.log.append({.kind = LogKind::TelecommandRefused,
                                       .source = incoming.source,
                                       .peer = header ? header->apid : std::uint16_t{0},
                                       .packet = incoming.packet,
                                       .note = to_text(notice.code())}));
  if (notice.code() == FailureCode::UnknownApid) parts_.own.verification().routing_failed(request, notice);
  else parts_.own.verification().rejected(request, notice);
}

}  // namespace hirosco::supervisor
