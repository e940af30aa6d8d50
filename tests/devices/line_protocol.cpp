// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/line_protocol.hpp"

#include <charconv>
#include <cstdio>
#include <cstring>
#include <span>

#include "hirosco/utilities/crc16.hpp"

namespace hirosco::testing {
namespace {

std::uint16_t check_of(std::string_view text) { return crc16(std::as_bytes(std::span{text})); }

}  // namespace

std::string LineProtocol::line(char kind, double value) {
  std::array<char, 48> text;
  const int used = std::snprintf(text.data(), text.size(), "%c %a", kind, value);
  std::string made{text.data(), static_cast<std::size_t>(used)};
  std::snprintf(text.data(), text.size(), "*%04x\n", check_of(made));
  return made + text.data();
}

std::optional<double> LineProtocol::value_in(std::string_view line, char kind) noexcept {
  const auto star = line.rfind('*');
  if (star == line.npos || star < 3 || line[0] != kind) return std::nullopt;
  std::uint16_t check = 0;
  const auto checked = std::from_chars(line.data() + star + 1, line.data() + line.size(), check, 16);
  if (checked.ptr != line.data() + line.size() || check != check_of(line.substr(0, star))) return std::nullopt;
  // As %a writes it: from_chars wants no 0x.
  std::string_view number = line.substr(2, star - 2);
  const bool negative = number.starts_with('-');
  if (negative) number.remove_prefix(1);
  if (number.size() < 3) return std::nullopt;
  double value = 0;
  const auto read = std::from_chars(number.data() + 2, number.data() + number.size(), value, std::chars_format::hex);
  if (read.ec != std::errc{}) return std::nullopt;
  return negative ? -value : value;
}

std::size_t LineProtocol::say(const DeviceCommand& command, MutableOctets out) noexcept {
  OctetReader reader{command.payload, std::endian::little};
  const double wanted = command.mode == DeviceMode::Active ? reader.get<double>() : 0;
  // Of numbers in a buffer: no memory, no locale.
  std::array<char, 64> text;
  text[0] = 'S', text[1] = ' ';
  char* at = text.data() + 2;
  if (wanted < 0) *at++ = '-';
  *at++ = '0', *at++ = 'x';
  at = std::to_chars(at, text.data() + 48, wanted < 0 ? -wanted : wanted, std::chars_format::hex).ptr;
  const std::uint16_t check = check_of({text.data(), static_cast<std::size_t>(at - text.data())});
  *at++ = '*';
  for (int digit = 3; digit >= 0; --digit) *at++ = "0123456789abcdef"[(check >> (4 * digit)) & 0xF];
  *at++ = '\n';
  const auto octets = static_cast<std::size_t>(at - text.data());
  std::memcpy(out.data(), text.data(), octets);
  return octets;
}

FrameProtocol::Heard LineProtocol::hear(Octets came) noexcept {
  Heard heard;
  for (const std::byte octet : came) {
    const auto character = static_cast<char>(octet);
    if (character != '\n') {
      if (used_ < line_.size()) line_[used_++] = character;
      continue;
    }
    if (const auto value = value_in({line_.data(), used_}, 'V')) {
      OctetWriter{payload_, std::endian::little}.put(*value);
      heard.whole = true;
      heard.payload = payload_;
    } else ++heard.damaged;
    used_ = 0;
  }
  return heard;
}

}  // namespace hirosco::testing
