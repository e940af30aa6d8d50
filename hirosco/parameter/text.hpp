// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/utf8.hpp"

/// Words of a fixed size, as a parameter of type TEXT holds them in memory and on the wire: UTF-8, zeros behind (docs/adr/0074).
namespace hirosco {

/// Most octets of a TEXT; an argument's takes two more for its length, and 256 in all.
inline constexpr std::size_t max_text_octets = 254;

/// As much of the front as fits `octets` without cutting a character in two; no more than its first NUL or what is no UTF-8.
/// Realtime: bounded.
[[nodiscard]] constexpr std::string_view cut_text(std::string_view text, std::size_t octets) noexcept {
  std::size_t end = 0;
  while (end < text.size() && text[end] != '\0') {
    const std::size_t next = character_octets(text.substr(end));
    if (next == 0 || end + next > octets) break;
    end += next;
  }
  return text.substr(0, end);
}

/// A text of at most N octets: a member or value of a parameter that is declared TEXT with `octets="N"`. It is copied octet by
/// octet, needs no heap, and has nothing but zeros behind its words. All of it: Realtime: bounded, no allocation.
template <std::size_t N>
class Text {
  static_assert(N >= 1 && N <= max_text_octets, "a TEXT has 1 to 254 octets");

 public:
  /// No words.
  constexpr Text() noexcept = default;
  /// What does not fit is cut behind a whole character; the rest of what is no UTF-8, too.
  constexpr explicit Text(std::string_view words) noexcept { *this = words; }
  template <std::size_t M>
  constexpr Text(const char (&words)[M]) noexcept {  // NOLINT: a literal is one
    static_assert(M - 1 <= N, "these words are longer than the text holds");
    *this = std::string_view{words, M - 1};
  }
  constexpr Text& operator=(std::string_view words) noexcept {
    const std::string_view whole = cut_text(words, N);
    // Words may be our own: they are moved before what is behind them is cleared.
    std::copy_n(whole.data(), whole.size(), octets_.begin());
    std::fill(octets_.begin() + static_cast<std::ptrdiff_t>(whole.size()), octets_.end(), '\0');
    return *this;
  }

  /// The words; they last as long as this object and its value.
  [[nodiscard]] constexpr std::string_view view() const noexcept {
    return {octets_.data(), static_cast<std::size_t>(std::ranges::find(octets_, '\0') - octets_.begin())};
  }
  [[nodiscard]] constexpr bool empty() const noexcept { return octets_.front() == '\0'; }
  [[nodiscard]] static constexpr std::size_t max_size() noexcept { return N; }
  friend constexpr bool operator==(const Text&, const Text&) noexcept = default;
  /// Words of any kind; a template, so that a literal is none but these.
  template <std::convertible_to<std::string_view> Words>
  friend constexpr bool operator==(const Text& text, const Words& words) noexcept {
    return text.view() == std::string_view{words};
  }

 private:
  std::array<char, N> octets_{};
};

/// The words of a TEXT as it stands in a report: what is in front of the first zero.  Realtime: bounded.
[[nodiscard]] inline std::string_view fixed_words(Octets octets) noexcept {
  const auto end = std::ranges::find(octets, std::byte{0});
  return {reinterpret_cast<const char*>(octets.data()), static_cast<std::size_t>(end - octets.begin())};
}
/// Whether octets are such a TEXT: UTF-8, and nothing but zeros behind it.  Realtime: bounded.
[[nodiscard]] inline bool is_fixed_text(Octets octets) noexcept {
  const std::string_view words = fixed_words(octets);
  return is_text(words) &&
         std::ranges::all_of(octets.subspan(words.size()), [](std::byte octet) { return octet == std::byte{0}; });
}

}  // namespace hirosco
