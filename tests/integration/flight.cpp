// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/flight.hpp"

#include <array>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::testing {

std::vector<std::byte> function_packet(std::uint16_t apid, std::uint16_t count, Octets data) {
  std::array<std::byte, max_packet_octets> buffer;
  const auto packet = pus::write_telecommand(
      buffer, {.apid = apid, .sequence_count = count, .ack = pus::ack_all, .service = 8, .subtype = 1, .source = 0},
      data);
  return {packet->begin(), packet->end()};
}

std::vector<std::byte> call_data(std::string_view name, const std::vector<double>& arguments) {
  constexpr std::size_t name_octets = 16;
  std::vector<std::byte> data(name_octets + 1 + arguments.size() * 9);
  OctetWriter writer{data};
  for (std::size_t i = 0; i < name_octets; ++i) writer.put(static_cast<std::uint8_t>(i < name.size() ? name[i] : '\0'));
  writer.put(static_cast<std::uint8_t>(arguments.size()));
  std::uint8_t id = 0;
  for (const double value : arguments) writer.put(++id).put(value);
  return data;
}

}  // namespace hirosco::testing
