// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hirosco {

/// Octets of the UTF-8 character at the front of `text`, which is not empty; 0 when it is not one (RFC 3629, 4).
[[nodiscard]] constexpr std::size_t character_octets(std::string_view text) noexcept {
  const auto octet = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto between = [&](std::size_t i, int low, int high) {
    return i < text.size() && octet(i) >= low && octet(i) <= high;
  };
  const unsigned first = octet(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return between(1, 0x80, 0xBF) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool second = between(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF);
    return second && between(2, 0x80, 0xBF) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool second = between(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF);
    return second && between(2, 0x80, 0xBF) && between(3, 0x80, 0xBF) ? 4 : 0;
  }
  return 0;
}

/// Whether it is UTF-8 without a NUL: what every reader of words takes for the same words.
[[nodiscard]] constexpr bool is_text(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t octets = text.front() == '\0' ? 0 : character_octets(text);
    if (octets == 0) return false;
    text.remove_prefix(octets);
  }
  return true;
}

/// Words that steer no terminal: a control character (C0, DEL, C1) or what is no UTF-8 is a '?'.
[[nodiscard]] inline std::string printable_words(std::string_view text) {
  std::string words;
  while (!text.empty()) {
    const std::size_t octets = character_octets(text);
    const auto octet = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const bool steers = octet(0) < ' ' || octet(0) == 0x7F || (octet(0) == 0xC2 && octets == 2 && octet(1) < 0xA0);
    if (octets == 0 || steers) words += '?';
    else words += text.substr(0, octets);
    text.remove_prefix(octets == 0 ? 1 : octets);
  }
  return words;
}

}  // namespace hirosco
