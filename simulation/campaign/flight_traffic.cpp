// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/flight_traffic.hpp"

#include <algorithm>
#include <array>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/crc32.hpp"

namespace hirosco::campaign {
namespace {

namespace st129 = pus::st129;

[[nodiscard]] std::string name_in(Octets data) {
  constexpr std::size_t name_octets = 16;
  std::string name;
  for (std::size_t i = 0; i < std::min(name_octets, data.size()); ++i) {
    const char letter = static_cast<char>(data[i]);
    if (letter == '\0') break;
    name += letter > ' ' && letter <= '~' ? letter : '?';
  }
  return name.empty() ? "?" : name;
}

/// What came down again, for who judges it: destination, number in the log and CRC-32 of the report inside; of the end of it destination, request,
/// reports, left out, missing, damaged and why it ended early, with '_' for each space ('-': it did not). Else nothing.
[[nodiscard]] std::string retrieved_in(const pus::TelemetryView& report) {
  if (report.service() != st129::service_type) return {};
  if (st129::is_retrieved(report)) {
    const auto again = st129::read_retrieved(report.source_data());
    return again ? fmt::format(" {} {} {}", report.destination(), again->number, crc32(again->packet)) : std::string{};
  }
  const auto end = st129::read_retrieval_end(report.source_data());
  if (report.subtype() != st129::retrieval_end || !end) return {};
  std::string why = end->why.empty() ? "-" : end->why;
  std::ranges::replace(why, ' ', '_');
  return fmt::format(" {} {} {} {} {} {} {}", report.destination(), end->request, end->reports, end->left_out,
                     end->missing, end->damaged, why);
}

}  // namespace

FlightTraffic::FlightTraffic(const descriptor::Mission& mission, simulation::Spacecraft& craft, WorldTrace& trace)
    : mission_{mission}, craft_{craft}, trace_{trace} {
  craft_.ground().on_telemetry([this](Octets packet) { received_on_ground(packet); });
}

bool FlightTraffic::send(const std::string& origin, const Header& header, Octets data) {
  const auto* member = mission_.find_subsystem(origin);
  const std::uint16_t source = member != nullptr ? member->subsystem.id : std::uint16_t{0};
  constexpr std::uint16_t modulo = 16'384;
  std::uint16_t& count = counts_[origin];
  count = static_cast<std::uint16_t>((count + 1) % modulo);
  std::array<std::byte, max_packet_octets> buffer;
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = header.apid,
                                              .sequence_count = count,
                                              .ack = header.ack,
                                              .service = header.service,
                                              .subtype = header.subtype,
                                              .source = source},
                                             data);
  if (!packet) return false;
  last_request_ = pus::read_primary_header(*packet)->request_id;
  return send_packet(origin, *packet);
}

bool FlightTraffic::send_packet(const std::string& origin, Octets packet) {
  bool sent = false;
  if (origin == ground) {
    sent = craft_.ground().send(packet);
  } else {
    sent = craft_.send_as(origin, packet);
  }
  const auto telecommand = pus::TelecommandView::parse(packet);
  if (telecommand) {
    const bool asks_again = telecommand->service() == st129::service_type && telecommand->subtype() == st129::retrieve;
    const Octets data = telecommand->application_data();
    const std::string what = telecommand->service() == 8   ? name_in(data)
                             : asks_again && !data.empty() ? hex_of(data)
                                                           : "-";
    trace_.say("{} {} {} {} {} {} {} {} {}", sent ? "sent" : "unsent", origin, telecommand->apid(),
               telecommand->sequence_count(), telecommand->source(), telecommand->ack(), telecommand->service(),
               telecommand->subtype(), what);
  } else {
    trace_.say("{} {} damaged", sent ? "sent" : "unsent", origin);
  }
  return sent;
}

FlightTraffic::Verdict FlightTraffic::verdict(std::uint32_t request) const {
  const auto found = verdicts_.find(request);
  return found != verdicts_.end() ? found->second : Verdict{};
}

void FlightTraffic::received_on_ground(Octets packet) {
  const auto report = pus::TelemetryView::parse(packet);
  if (!report) return;
  if (report->service() != 1) {
    trace_.say("down {} {} {} {}{}", report->apid(), report->sequence_count(), report->service(), report->subtype(),
               retrieved_in(*report));
    return;
  }
  OctetReader reader{report->source_data()};
  const auto request = reader.get<std::uint32_t>();
  trace_.say("down {} {} {} {} {} {}", report->apid(), report->sequence_count(), report->service(), report->subtype(),
             report->destination(), request);
  if (report->destination() != 0) return;
  const bool step_failed = report->subtype() == 6;  // it goes on
  if ((report->subtype() % 2 == 0 && !step_failed) || report->subtype() == 7)
    verdicts_[request] = {.over = true, .completed = report->subtype() == 7};
}

}  // namespace hirosco::campaign
