// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

/// What a subsystem says: reports of its cycle, telemetry, events.
namespace hirosco {
namespace {

constexpr Duration losses_told_every = 1s;

/// Of two numbers that count on past their end.
[[nodiscard]] constexpr bool comes_before(std::uint32_t a, std::uint32_t b) noexcept {
  return static_cast<std::int32_t>(a - b) < 0;
}

[[nodiscard]] std::uint64_t lost_by_loops(const std::vector<std::unique_ptr<OwnLoop>>& loops) {
  std::uint64_t sum = 0;
  for (const auto& loop : loops) sum += loop->lost();
  return sum;
}

[[nodiscard]] Failure failure_in(Octets payload) {
  AuthorsError failure;
  std::memcpy(&failure, payload.data(), std::min(payload.size(), sizeof failure));
  return {failure.code, {failure.text.data(), failure.text_octets}, failure.number};
}

}  // namespace

/// Answers and events in the order in which the cycle made them, housekeeping behind.
void GenericSubsystem::take_cycle_reports() {
  const auto head_of = [](Octets record) {
    CycleReport head;
    std::memcpy(&head, record.data(), sizeof head);
    return head;
  };
  const auto take = [&](RecordRing& ring, const CycleReport& head, Octets record) {
    take_cycle_report(head, record.subspan(sizeof head));
    ring.pop();
  };
  for (;;) {
    const auto event = rings_.events.front();
    // Looked at last: an answer that was made before this event is seen, too.
    const auto answer = rings_.answers.front();
    if (!event && !answer) break;
    const bool answer_first = answer && (!event || comes_before(head_of(*answer).number, head_of(*event).number));
    if (answer_first) take(rings_.answers, head_of(*answer), *answer);
    else take(rings_.events, head_of(*event), *event);
  }
  while (const auto record = rings_.housekeeping.front()) take(rings_.housekeeping, head_of(*record), *record);
}

void GenericSubsystem::take_cycle_report(const CycleReport& head, Octets payload) {
  switch (head.kind) {
    case ReportKind::Housekeeping: report(3, 25, 0, payload); break;
    case ReportKind::Event: raise_event(head.index, payload); break;
    case ReportKind::Started:
      open_calls_.push_back(head.request);
      verification_.started(head.request);
      break;
    case ReportKind::Refused:
      verification_.start_failed(head.request, notice_of(head.index, failure_in(payload)));
      break;
    case ReportKind::Progressed: verification_.progressed(head.request, head.index); break;
    case ReportKind::Finished:
      if (close_call(head.request)) verification_.completed(head.request);
      break;
    case ReportKind::Aborted:
      if (close_call(head.request))
        verification_.completion_failed(head.request, notice_of(head.index, failure_in(payload)));
      break;
    case ReportKind::StateEntered:
      if (awaiting_cycle_ && way_ && static_cast<State>(head.index) == way_->states[way_at_]) {
        // Where a device has not answered yet nobody can say that it was a success (docs/adr/0147).
        answer_owed_ = state_ == State::PreOperational && way_->states[way_at_] == State::SafeOperational;
        if (answer_owed_) return look_for_first_answer();
        awaiting_cycle_ = false;
        arrive(way_->states[way_at_]);
      } else if (!way_ && wanted_.load(std::memory_order_relaxed) && static_cast<State>(head.index) != state_) {
        // One whose time was over, and who comes after all: the cycle is where it says, and what follows begins there.
        be_in(static_cast<State>(head.index));
      }
      break;
    case ReportKind::EntryRefused:
      if (awaiting_cycle_ && way_ && static_cast<State>(head.index) == way_->states[way_at_])
        fail_transition(static_cast<State>(head.index), failure_in(payload));
      break;
    case ReportKind::NodeFailed:
      // While the cycle comes to rest the subsystem is on its way down already: Error-Operational has no cycle there.
      if (wanted_.load(std::memory_order_relaxed)) fail_transition(static_cast<State>(head.index), failure_in(payload));
      else
        raise_failure(descriptor::framework_event::state_failed, static_cast<std::uint8_t>(head.index),
                      failure_in(payload));
      break;
    case ReportKind::InputDetached:
    case ReportKind::OutputDetached:
      std::erase_if(leaving_links_, [&](const auto& link) { return link.get() == head.link; });
      break;
    case ReportKind::Reconfigured: reconfigured(static_cast<std::uint8_t>(head.index), std::nullopt); break;
    case ReportKind::NotReconfigured: reconfigured(static_cast<std::uint8_t>(head.index), failure_in(payload)); break;
    case ReportKind::SelfTestEnded: self_tests_.ended(head.request, head.index, failure_in(payload)); break;
  }
}

void GenericSubsystem::report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination,
                              Octets source_data) {
  std::array<std::byte, max_packet_octets> buffer;
  pus::TelemetryHeader header{.apid = descriptor_.id,
                              .service = service,
                              .subtype = subtype,
                              .destination = destination,
                              .time = platform_.clock.onboard()};
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

/// Each loss is counted where it happens; here the counts become an event.
void GenericSubsystem::tell_losses(TimePoint now) {
  const std::array losses{rings_.lost_answers(),
                          rings_.lost_events(),
                          rings_.housekeeping.dropped(),
                          backlog_.lost(Backlog::Worth::Answer) + lost_by_loops(loops_),
                          backlog_.lost(Backlog::Worth::Event),
                          backlog_.lost(Backlog::Worth::Housekeeping)};
  // To a supervisor that does not listen it would only be one more that is lost.
  if (losses == told_losses_ || now - losses_told_at_ < losses_told_every || !backlog_.empty()) return;
  told_losses_ = losses;
  losses_told_at_ = now;
  std::array<double, losses.size()> arguments{};
  std::ranges::transform(losses, arguments.begin(), [](std::uint64_t count) { return static_cast<double>(count); });
  raise_in_service(descriptor::framework_event::reports_lost, arguments);
}

/// An event once for each crossing of the level that the descriptor says.
void GenericSubsystem::look_at_resources(TimePoint now) {
  if (now < look_at_resources_at_) return;
  look_at_resources_at_ = now + ResourceMeter::look_every;
  if (platform_.usage)
    if (const auto usage = platform_.usage()) resources_.note(*usage);
  resources_.note_held();
  resources_.tell_crossings([this](const ResourceMeter::Crossing& found) {
    const std::array<double, 5> arguments{static_cast<double>(found.resource), static_cast<double>(found.block_octets),
                                          static_cast<double>(found.used), static_cast<double>(found.limit),
                                          static_cast<double>(found.times)};
    raise_in_service(descriptor::framework_event::resource_warning, arguments);
  });
}

Result<> GenericSubsystem::submit_ground_telecommand(std::uint16_t client, Octets packet, std::uint32_t known_stop) {
  // Its own reports come first: telecommands that overtake them would keep them from ever being sent.
  if (!backlog_.empty()) return fail(ErrorCode::ResourceExhausted, "reports wait for the supervisor");
  return channel_.send({.kind = MessageKind::GroundTelecommand, .epoch = known_stop, .link = client, .packet = packet});
}

Result<std::uint32_t> GenericSubsystem::send_request(const RequestPort& asked, pus::GivenValues values) {
  // As above: what is under way would never be heard to end.
  if (!backlog_.empty()) return fail(ErrorCode::ResourceExhausted, "reports wait for the supervisor");
  return requester_.send(asked, values, platform_.clock.now(), known_stop_);
}

/// The supervisor is told of every event; ST[05] is one that listens, and may be told to be silent (adr 0020).
void GenericSubsystem::raise_event(std::uint16_t event, Octets auxiliary) {
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

void GenericSubsystem::raise_named(std::string_view event, Octets auxiliary) {
  const descriptor::Event* declared = descriptor_.find_event(event);
  if (declared != nullptr && pus::octets_of(*declared) == auxiliary.size()) raise_event(declared->id, auxiliary);
}

void GenericSubsystem::raise_in_service(std::uint16_t event, std::span<const double> arguments) {
  const auto found = std::ranges::find(descriptor_.events, event, &descriptor::Event::id);
  if (found == descriptor_.events.end()) return;
  std::array<std::byte, max_packet_octets> buffer;
  raise_event(event, pus::fill_arguments(*found, arguments, buffer));
}

void GenericSubsystem::announce(std::string_view event_name, std::initializer_list<double> arguments) {
  if (const descriptor::Event* event = descriptor_.find_event(event_name))
    raise_in_service(event->id, std::span{arguments.begin(), arguments.size()});
}

void GenericSubsystem::raise_failure(std::uint16_t event, std::uint8_t what, const Failure& why) {
  std::array<std::byte, 1 + 1 + 8 + descriptor::framework_event::text_octets> auxiliary{};
  OctetWriter writer{auxiliary};
  writer.put(what).put(static_cast<std::uint8_t>(why.code)).put(why.number);
  const std::string_view text = std::string_view{why.text}.substr(0, descriptor::framework_event::text_octets);
  writer.put(std::as_bytes(std::span{text}));
  raise_event(event, auxiliary);
}

}  // namespace hirosco
