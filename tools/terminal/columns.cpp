// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/columns.hpp"

#include <locale.h>
#include <wchar.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "hirosco/utilities/utf8.hpp"

namespace hirosco::terminal {
namespace {

/// wcwidth() asks the locale of the thread; that of the user may know no Unicode.
class Unicode {
 public:
  Unicode() : locale_{::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)} {
    if (locale_ != nullptr) before_ = ::uselocale(locale_);
  }
  ~Unicode() {
    if (locale_ == nullptr) return;
    ::uselocale(before_);
    ::freelocale(locale_);
  }
  Unicode(const Unicode&) = delete;
  Unicode& operator=(const Unicode&) = delete;
  /// Less than 0: nobody knows.
  [[nodiscard]] int width(char32_t character) const { return ::wcwidth(static_cast<wchar_t>(character)); }

 private:
  locale_t locale_;
  locale_t before_{};
};

[[nodiscard]] char32_t decoded(std::string_view octets) {
  const auto octet = [&](std::size_t i) { return static_cast<char32_t>(static_cast<unsigned char>(octets[i])); };
  constexpr std::array<char32_t, 5> first{0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t character = octet(0) & first[octets.size()];
  for (std::size_t i = 1; i < octets.size(); ++i) character = character << 6 | (octet(i) & 0x3F);
  return character;
}

/// Latin letters, and the marks and arrows of the screen itself: nobody has to be asked, which takes longer than all the rest.
[[nodiscard]] constexpr bool is_surely_one_column(char32_t character) noexcept {
  const auto between = [&](char32_t low, char32_t high) { return character >= low && character <= high; };
  return between(0x20, 0x7E) || between(0xA1, 0xAC) || between(0xAE, 0x2FF) || between(0x2190, 0x21FF) ||
         between(0x25A0, 0x25CF) || character == 0x2026;
}

/// Calls `with(octets of one character, its columns)` until that says no; those of no known width come as "?".
template <class With>
void each_character(std::string_view text, With&& with) {
  const bool plain = std::ranges::all_of(text, [](char c) { return c >= ' ' && c < 0x7F; });
  if (plain) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (!with(text.substr(i, 1), std::size_t{1})) return;
    return;
  }
  std::optional<Unicode> unicode;
  const std::string words = printable_words(text);
  for (std::string_view rest = words; !rest.empty();) {
    const std::string_view octets = rest.substr(0, character_octets(rest));
    int columns = 1;
    if (!is_surely_one_column(decoded(octets))) {
      if (!unicode) unicode.emplace();
      columns = unicode->width(decoded(octets));
    }
    if (!(columns < 0 ? with("?", std::size_t{1}) : with(octets, static_cast<std::size_t>(columns)))) return;
    rest.remove_prefix(octets.size());
  }
}

}  // namespace

std::size_t width_of(std::string_view text) {
  std::size_t width = 0;
  each_character(text, [&](std::string_view, std::size_t columns) {
    width += columns;
    return true;
  });
  return width;
}

std::string cut(std::string_view text, std::size_t width) {
  std::string whole, shorter;
  std::size_t used = 0;
  bool fits = true;
  each_character(text, [&](std::string_view octets, std::size_t columns) {
    used += columns;
    if (used > width) return fits = false;
    whole += octets;
    // One column stays for the mark, which a character that combines must not get onto.
    if (used < width) shorter = whole;
    return true;
  });
  if (fits) return whole;
  if (width == 0) return {};
  return shorter + "…";
}

std::string left(std::string_view text, std::size_t width) {
  std::string shown = cut(text, width);
  return shown + std::string(width - std::min(width, width_of(shown)), ' ');
}

std::string right(std::string_view text, std::size_t width) {
  const std::string shown = cut(text, width);
  return std::string(width - std::min(width, width_of(shown)), ' ') + shown;
}

std::string ascii(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, char>, 9> known{
      {{"…", '~'}, {"●", '*'}, {"▲", '^'}, {"■", '#'}, {"◆", 'o'}, {"·", '.'}, {"→", '>'}, {"↑", '^'}, {"↓", 'v'}}};
  std::string shown;
  each_character(text, [&](std::string_view octets, std::size_t columns) {
    const auto* same = std::ranges::find(known, octets, &std::pair<std::string_view, char>::first);
    if (octets.size() == 1) shown += octets;
    else if (same != known.end()) shown += same->second;
    else shown += std::string(columns, '?');
    return true;
  });
  return shown;
}

}  // namespace hirosco::terminal
