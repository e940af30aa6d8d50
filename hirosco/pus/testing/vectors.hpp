// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/octets.hpp"

/// Octets that other implementations made (README: Test vectors), for tests of this library.
namespace hirosco::pus::testing {

using Bytes = std::vector<std::byte>;

[[nodiscard]] inline Bytes from_hex(std::string_view text) {
  Bytes bytes;
  std::string digits;
  for (const char c : text)
    if (c != ' ') digits += c;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(std::stoul(digits.substr(i, 2), nullptr, 16)));
  return bytes;
}

[[nodiscard]] inline std::string to_hex(Octets octets) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const std::byte octet : octets) {
    text += digits[std::to_integer<std::size_t>(octet) >> 4];
    text += digits[std::to_integer<std::size_t>(octet) & 15];
  }
  return text;
}

struct Vector {
  std::string id;
  std::string group;
  nlohmann::json fields;
  Bytes octets;
};

/// All vectors of a group, never none.
[[nodiscard]] inline std::vector<Vector> vectors(std::string_view group) {
  std::ifstream file{HIROSCO_SOURCE_DIR "/hirosco/pus/testing/test_vectors.json"};
  std::vector<Vector> found;
  for (const auto& row : nlohmann::json::parse(file))
    if (row.at("group") == group)
      found.push_back({row.at("id"), row.at("group"), row.at("fields"), from_hex(row.at("hex").get<std::string>())});
  if (found.empty()) throw std::runtime_error{"no vectors of group " + std::string{group}};
  return found;
}

/// The one vector with this id.
[[nodiscard]] inline Vector vector_of(std::string_view group, std::string_view id) {
  for (auto& candidate : vectors(group))
    if (candidate.id == id) return candidate;
  throw std::runtime_error{"no vector " + std::string{id}};
}

/// Headers as a vector's fields give them.
[[nodiscard]] inline TelecommandHeader telecommand_header(const nlohmann::json& fields) {
  TelecommandHeader header;
  header.apid = fields.at("apid");
  header.sequence_count = fields.at("seq");
  header.ack = static_cast<std::uint8_t>(std::stoul(fields.at("ack").get<std::string>(), nullptr, 16));
  header.service = fields.at("service");
  header.subtype = fields.at("subtype");
  header.source = fields.at("source");
  return header;
}
[[nodiscard]] inline TelemetryHeader telemetry_header(const nlohmann::json& fields) {
  TelemetryHeader header;
  header.apid = fields.at("apid");
  header.sequence_count = fields.at("seq");
  header.time_status = fields.value("time_status", std::uint8_t{0});
  header.service = fields.value("service", std::uint8_t{0});
  header.subtype = fields.value("subtype", std::uint8_t{0});
  header.message_count = fields.at("counter");
  header.destination = fields.at("destination");
  header.time = from_cuc(from_hex(fields.at("time").get<std::string>()));
  return header;
}

}  // namespace hirosco::pus::testing
