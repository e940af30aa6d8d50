// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st05_event/event_service.hpp"

#include <algorithm>
#include <array>

#include "hirosco/parameter/number.hpp"
#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco::pus {
namespace {
constexpr std::size_t max_auxiliary_octets = max_telemetry_octets - telemetry_overhead_octets - 2;

[[nodiscard]] std::uint16_t id_at(Octets data, std::size_t index) noexcept {
  return OctetReader{data.subspan(1 + 2 * index, 2)}.get<std::uint16_t>();
}
}  // namespace

namespace st05 {
constexpr Part id[]{number("EVENT", Type::Uint16)};
constexpr Part ids[]{list("EVENTS", id)};
constexpr Part event[]{number("EVENT", Type::Uint16), {.name = "ARGUMENTS", .form = Form::Rest}};
using enum EventService::Subtype;
constexpr RequestKind requests[]{{enable_reports, "ENABLE_EVENTS", ids},
                                 {disable_reports, "DISABLE_EVENTS", ids},
                                 {report_disabled, "REPORT_DISABLED", {}}};
constexpr ReportKind reports[]{
    {1, "info", event}, {2, "low", event}, {3, "medium", event}, {4, "high", event}, {disabled_list, "DISABLED", ids}};
}  // namespace st05

const ServiceKind EventService::service_kind{
    .type = service_type, .name = "events", .requests = st05::requests, .reports = st05::reports};

EventService::EventService(const std::vector<descriptor::Event>& events, Verification& verification,
                           TelemetrySink& sink)
    : verification_{verification}, sink_{sink} {
  for (const auto& event : events) events_.push_back({event.id, event.severity, octets_of(event), true});
}

Result<> EventService::raise(std::uint16_t event_id, Octets auxiliary_data) {
  const Definition* event = find(event_id);
  if (event == nullptr) return fail(ErrorCode::NotFound, "event", event_id);
  if (auxiliary_data.size() != event->octets || auxiliary_data.size() > max_auxiliary_octets)
    return fail(ErrorCode::Mismatch, "auxiliary data of an event", event_id);
  if (!event->enabled) return ok();
  std::array<std::byte, 2 + max_auxiliary_octets> buffer;
  OctetWriter writer{buffer};
  writer.put(event_id).put(auxiliary_data);
  sink_.report(service_type, static_cast<std::uint8_t>(event->severity), 0, writer.written());
  return ok();
}

bool EventService::report_enabled(std::uint16_t event_id) const noexcept {
  return std::ranges::any_of(events_, [event_id](const Definition& e) { return e.id == event_id && e.enabled; });
}

void EventService::set_reported(std::uint16_t event_id, bool reported) noexcept {
  if (Definition* event = find(event_id); event != nullptr) event->enabled = reported;
}

EventService::Definition* EventService::find(std::uint16_t event_id) noexcept {
  const auto found = std::ranges::find(events_, event_id, &Definition::id);
  return found == events_.end() ? nullptr : &*found;
}

void EventService::handle(const TelecommandView& telecommand, const Request& request) {
  const Octets data = telecommand.application_data();
  switch (telecommand.subtype()) {
    case enable_reports: return switch_reports(data, request, true);
    case disable_reports: return switch_reports(data, request, false);
    case report_disabled:
      if (!data.empty()) return verification_.rejected(request, FailureNotice{FailureCode::DataLength});
      return report_disabled_events(request);
    default: return verification_.rejected(request, unknown_subtype(telecommand));
  }
}

void EventService::switch_reports(Octets data, const Request& request, bool enabled) {
  const auto count = list_count(data, 2);
  if (!count) return verification_.rejected(request, count.error());
  verification_.accepted(request);
  run_instructions(
      verification_, request, *count,
      [this, data](std::size_t i) -> std::optional<FailureNotice> {
        if (find(id_at(data, i)) != nullptr) return std::nullopt;
        return instruction_failure(FailureCode::UnknownIdentifier, i, id_at(data, i));
      },
      [this, data, enabled](std::size_t i) { find(id_at(data, i))->enabled = enabled; });
}

void EventService::report_disabled_events(const Request& request) {
  verification_.accepted(request);
  verification_.started(request);
  auto left = static_cast<std::size_t>(std::ranges::count_if(events_, [](const auto& each) { return !each.enabled; }));
  auto event = events_.begin();
  do {
    std::size_t part = std::min(left, max_instructions);
    left -= part;
    std::array<std::byte, 1 + 2 * max_instructions> buffer;
    OctetWriter writer{buffer};
    writer.put(static_cast<std::uint8_t>(part));
    for (; part > 0; ++event)
      if (!event->enabled) {
        writer.put(event->id);
        --part;
      }
    sink_.report(service_type, disabled_list, request.source, writer.written());
  } while (left > 0);
  verification_.completed(request);
}

Result<Octets> encode_arguments(const descriptor::Event& event, std::span<const double> values,
                                MutableOctets buffer) noexcept {
  std::size_t expected = 0;
  for (const auto& argument : event.arguments) expected += argument.count;
  if (values.size() != expected)
    return fail(ErrorCode::InvalidArgument, "number of event arguments", static_cast<std::int64_t>(values.size()));
  OctetWriter writer{buffer};
  for (const auto& argument : event.arguments)
    for (std::size_t i = 0; i < argument.count; ++i) {
      put_number(writer, argument.type, values.front());
      values = values.subspan(1);
    }
  if (!writer.good())
    return fail(ErrorCode::ResourceExhausted, "event buffer", static_cast<std::int64_t>(buffer.size()));
  return writer.written();
}

Octets fill_arguments(const descriptor::Event& event, std::span<const double> values, MutableOctets buffer) noexcept {
  OctetWriter writer{buffer};
  std::size_t next = 0;
  for (const auto& argument : event.arguments)
    for (std::size_t i = 0; i < argument.count; ++i, ++next)
      put_number(writer, argument.type, next < values.size() ? values[next] : 0.0);
  return writer.written();
}

std::size_t octets_of(const descriptor::Event& event) noexcept {
  std::size_t octets = 0;
  for (const auto& argument : event.arguments) octets += argument.octets();
  return octets;
}

}  // namespace hirosco::pus
