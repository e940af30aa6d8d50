// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/incoming.hpp"

#include <algorithm>
#include <utility>

namespace hirosco {
namespace {

constexpr int messages_per_step = 64;

}  // namespace

void Incoming::receive() {
  MessageBuffer buffer;
  // A telecommand whose answers might crowd out those to another stays in the channel: the supervisor finds that full and
  // says so, while an answer that is dropped is a telecommand of which nobody ever hears again (adr 0029).
  for (int left = messages_per_step; left > 0 && parts_.reports.answers_have_room(); --left) {
    auto found = parts_.channel.receive(buffer);
    if (!found) {
      // One damaged message is no loss of the supervisor: the next look goes on behind it.
      if (found.error().code == ErrorCode::Unavailable) parts_.permit.note_gone();
      return;
    }
    if (found->flow == Flow::None) return;
    if (found->message.kind == MessageKind::Packet) dispatch(found->message);
    else if (found->message.kind == MessageKind::PermitPage) parts_.permit.take(found->message.memory);
  }
}

/// Before anything that a new mode permits is looked at: a loop of ST[20]'s own is done with what it judged by the one before, or judges
/// it by the new one (docs/adr/0200).
void Incoming::follow_mode() {
  const std::uint32_t epoch = parts_.permit.page().mode_epoch.load(std::memory_order_acquire);
  if (std::exchange(mode_epoch_, epoch) == epoch) return;
  const LockGuard lock{parts_.values.judging()};
}

void Incoming::dispatch(const Message& message) {
  const auto header = pus::read_primary_header(message.packet);
  if (!header) return;
  if (!header->telecommand) {
    if (const auto report = pus::TelemetryView::parse(message.packet)) {
      if (parts_.subscriber.hear(*report)) return;
      if (parts_.requester.waits() && report->destination() == parts_.descriptor.id) parts_.requester.hear(*report);
    }
    return parts_.author.telemetry(message.packet);
  }
  if (pus::to_be_discarded(message.packet)) return;
  follow_mode();
  const auto telecommand = pus::TelecommandView::parse(message.packet);
  if (!telecommand) return parts_.reports.verification().rejected({header->request_id, 0, 0}, telecommand.error());
  const pus::Request request = pus::request_of(*telecommand);
  if (telecommand->apid() != parts_.descriptor.id)
    return parts_.reports.verification().routing_failed(request, pus::FailureNotice{pus::FailureCode::UnknownApid});
  if (message.epoch != 0 && message.epoch != parts_.permit.page().mode_epoch.load(std::memory_order_acquire))
    return parts_.reports.verification().rejected(request, pus::FailureNotice{pus::FailureCode::WrongMode});
  pus::Service* const service = parts_.services.find(telecommand->service());
  if (service == nullptr || !parts_.descriptor.offers(telecommand->service(), parts_.at.configuration))
    return parts_.reports.verification().rejected(
        request, pus::FailureNotice{pus::FailureCode::UnknownService}.with(telecommand->service()));
  if (!service->in_force()) return parts_.reports.verification().rejected(request, parts_.at.wrong_state());
  if (OwnLoop* const loop = parts_.loops.of(service->type())) {
    if (loop->offer(message.packet, message.epoch)) return;
    return parts_.reports.verification().rejected(request, pus::FailureNotice{pus::FailureCode::QueueFull});
  }
  service->accompany(message.memory);
  service->handle(*telecommand, request);
}

}  // namespace hirosco
