// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/reports.hpp"

#include <algorithm>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"

namespace hirosco {
namespace {

constexpr Duration losses_told_every = 1s;

}  // namespace

Reports::Reports(const descriptor::SubsystemDescriptor& descriptor, const Clock& clock, Channel& channel,
                 VitalPage& vital)
    : descriptor_{descriptor},
      clock_{clock},
      channel_{channel},
      counters_{vital.counters},
      verification_{*this},
      event_service_{descriptor_.events, verification_, *this},
      backlog_{descriptor_.resources.waiting} {}

void Reports::report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets source_data) {
  std::array<std::byte, max_packet_octets> buffer;
  pus::TelemetryHeader header{.apid = descriptor_.id,
                              .service = service,
                              .subtype = subtype,
                              .destination = destination,
                              .time = clock_.onboard()};
  counters_.stamp(header);
  constexpr std::uint8_t housekeeping_report = 25;
  const bool event = service == pus::EventService::service_type && subtype <= 4;
  const bool housekeeping = service == 3 && subtype == housekeeping_report;
  const auto worth = event          ? Backlog::Worth::Event
                     : housekeeping ? Backlog::Worth::Housekeeping
                                    : Backlog::Worth::Answer;
  const auto packet = pus::write_telemetry(buffer, header, source_data);
  if (packet) backlog_.send(channel_, {.packet = *packet}, worth);
}

QueueFill Reports::take_channel_fill() noexcept {
  const Channel::Fill now = channel_.outbound();
  if (now.room == 0) return {};
  const std::uint64_t room = descriptor_.resources.channel_kb.value_or(now.room);
  channel_mark_.note(std::min((now.used * room + now.room - 1) / now.room, room), backlog_.channel_refusals(), room);
  return {channel_mark_.take(), static_cast<std::uint32_t>(room)};
}

/// Each loss is counted where it happens; here the counts become an event.
void Reports::tell_losses(TimePoint now, const LoopRings& of_cycle, std::uint64_t of_own_loops) {
  const std::array losses{of_cycle.lost_answers(),
                          of_cycle.lost_events(),
                          of_cycle.housekeeping.dropped(),
                          backlog_.lost(Backlog::Worth::Answer) + of_own_loops,
                          backlog_.lost(Backlog::Worth::Event),
                          backlog_.lost(Backlog::Worth::Housekeeping)};
  // To a supervisor that does not listen it would only be one more that is lost.
  if (losses == told_losses_ || now - losses_told_at_ < losses_told_every || !backlog_.empty()) return;
  told_losses_ = losses;
  losses_told_at_ = now;
  std::array<double, losses.size()> arguments{};
  std::ranges::transform(losses, arguments.begin(), [](std::uint64_t count) { return static_cast<double>(count); });
  raise(descriptor::framework_event::reports_lost, arguments);
}

/// The supervisor is told of every event; ST[05] is one that listens, and may be told to be silent (adr 0020).
void Reports::raise_encoded(std::uint16_t event, Octets auxiliary) {
  const auto found = std::ranges::find(descriptor_.events, event, &descriptor::Event::id);
  if (found == descriptor_.events.end()) return;
  std::array<std::byte, max_packet_octets> buffer;
  const auto reported = event_service_.report_enabled(event) ? pus::Reported::Yes : pus::Reported::No;
  const auto octets = pus::write_event_message(
      buffer, {.severity = found->severity, .reported = reported, .id = event, .auxiliary = auxiliary});
  // What the supervisor reacts to must not be crowded out by what an author remarks.
  const auto worth = found->severity >= descriptor::Severity::Medium ? Backlog::Worth::Answer : Backlog::Worth::Event;
  if (octets) backlog_.send(channel_, {.kind = MessageKind::Event, .packet = *octets}, worth);
  static_cast<void>(event_service_.raise(event, auxiliary));
}

void Reports::raise(std::uint16_t event, std::span<const double> arguments) {
  const auto found = std::ranges::find(descriptor_.events, event, &descriptor::Event::id);
  if (found == descriptor_.events.end()) return;
  std::array<std::byte, max_packet_octets> buffer;
  raise_encoded(event, pus::fill_arguments(*found, arguments, buffer));
}

void Reports::raise_named(std::string_view event, Octets auxiliary) {
  const descriptor::Event* declared = descriptor_.find_event(event);
  if (declared != nullptr && pus::octets_of(*declared) == auxiliary.size()) raise_encoded(declared->id, auxiliary);
}

void Reports::announce(std::string_view event, std::initializer_list<double> arguments) {
  if (const descriptor::Event* declared = descriptor_.find_event(event))
    raise(declared->id, std::span{arguments.begin(), arguments.size()});
}

void Reports::raise_failure(std::uint16_t event, std::uint8_t what, const Failure& why) {
  std::array<std::byte, 1 + 1 + 8 + descriptor::framework_event::text_octets> auxiliary{};
  OctetWriter writer{auxiliary};
  writer.put(what).put(static_cast<std::uint8_t>(why.code)).put(why.number);
  const std::string_view text = std::string_view{why.text}.substr(0, descriptor::framework_event::text_octets);
  writer.put(std::as_bytes(std::span{text}));
  raise_encoded(event, auxiliary);
}

pus::FailureNotice Reports::notice_of(std::uint16_t code, const pus::Reason& why) const noexcept {
  const bool own = code >= pus::first_own_failure_code;
  if (own &&
      std::ranges::find(descriptor_.failures, code, &descriptor::FailureName::code) == descriptor_.failures.end())
    return pus::FailureNotice{pus::FailureCode::ExecutionError}.because(
        {ErrorCode::NotFound, code, "failure code without a name in the descriptor"});
  pus::FailureNotice notice{static_cast<pus::FailureCode>(code)};
  if (!why.text.empty() || why.number != 0) notice.because(why);
  return notice;
}

}  // namespace hirosco
