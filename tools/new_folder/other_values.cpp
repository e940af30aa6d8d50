// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/other_values.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace hirosco::tools {

namespace {

/// Lines and columns count from 1, columns in characters.
[[nodiscard]] std::size_t octet_of(std::string_view text, xml::Position at) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::size_t octet = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  for (int line = 1; line < at.line; ++line) octet = std::min(text.find('\n', octet), text.size() - 1) + 1;
  const auto goes_on = [&] {
    return octet < text.size() && (static_cast<unsigned char>(text[octet]) & 0xC0U) == 0x80U;
  };
  for (int column = 1; column < at.column && octet < text.size(); ++column) do
      ++octet;
    while (goes_on());
  return octet;
}

}  // namespace

std::string with_values(std::string_view text, const std::vector<OtherValue>& values) {
  std::map<std::size_t, std::pair<std::size_t, std::string_view>>
      in_order;  // by octets: where it ends, what it is then
  for (const OtherValue& each : values) {
    const std::size_t at = octet_of(text, each.value_at);
    // As long as the quote before it does not come again.
    const auto end = at > 0 && at <= text.size() ? text.find(text[at - 1], at) : std::string_view::npos;
    if (end != std::string_view::npos) in_order[at] = {end, each.value};
  }
  std::string made;
  std::size_t done = 0;
  for (const auto& [at, other] : in_order) {
    made += text.substr(done, at - done);
    made += other.second;
    done = other.first;
  }
  return made += text.substr(done);
}

}  // namespace hirosco::tools
