// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/named_commands.hpp"

#include <algorithm>
#include <array>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::uint16_t ground_source = 0;

}  // namespace

std::vector<std::byte> NamedCommands::write(std::string_view subsystem, std::string_view name,
                                            const std::vector<Value>& arguments) {
  const auto* target = mission_.find_member(subsystem);
  if (target == nullptr) return {};
  const std::vector<descriptor::Function> requests = pus::requests_of(*target);
  const auto request = std::ranges::find(requests, name, &descriptor::Function::name);
  if (request == requests.end()) return {};
  const std::vector<std::optional<Value>> given(arguments.begin(), arguments.end());
  const auto data = pus::encode_request(*request, pus::GivenValues{given});
  if (!data) return {};
  static constexpr std::uint16_t modulo = 16'384;
  std::array<std::byte, max_packet_octets> buffer;
  sequence_ = static_cast<std::uint16_t>((sequence_ + 1) % modulo);
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = target->id,
                                              .sequence_count = sequence_,
                                              .ack = pus::ack_all,
                                              .service = request->service,
                                              .subtype = request->subtype,
                                              .source = ground_source},
                                             *data);
  return packet ? std::vector<std::byte>(packet->begin(), packet->end()) : std::vector<std::byte>{};
}

FollowedCommand::FollowedCommand(SimulatedGround& ground, Octets packet)
    : ground_{ground}, request_id_{pus::read_primary_header(packet)->request_id} {
  ground_.on_telemetry([this](Octets octets) { receive(octets); });
}

FollowedCommand::~FollowedCommand() { ground_.on_telemetry({}); }

void FollowedCommand::receive(Octets packet) {
  const auto report = pus::TelemetryView::parse(packet);
  if (!report || report->service() != 1) return;
  OctetReader reader{report->source_data()};
  if (reader.get<std::uint32_t>() != request_id_) return;
  switch (report->subtype()) {
    case 1: outcome_.accepted = true; return;
    case 3: outcome_.started = true; return;
    case 5: ++outcome_.progress_reports; return;
    case 6: return;  // one of its steps: it goes on
    case 7: outcome_.completed = true; return;
    default: break;
  }
  outcome_.failure = static_cast<pus::FailureCode>(reader.get<std::uint16_t>());
  outcome_.failure_subtype = report->subtype();
}

}  // namespace hirosco::simulation
