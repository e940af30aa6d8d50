// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/flight_lock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>

namespace hirosco::tools {
namespace {

/// Whoever wrote another one: nobody is waited for longer.
constexpr std::chrono::milliseconds longest_limit{120'000};

template <class Number>
[[nodiscard]] bool read_whole(std::string_view text, Number& number) {
  const auto [behind, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  return problem == std::errc{} && behind == text.data() + text.size();
}

}  // namespace

std::string lock_text(const FlightLock& lock) {
  return fmt::format("{} {} {} {}\n", lock.keeper, lock.limit.count(), lock.mission, FlightLock::version);
}

std::expected<FlightLock, std::string> lock_from_text(std::string_view text) {
  std::array<std::string_view, 5> words;
  std::size_t count = 0;
  while (!text.empty() && count < words.size()) {
    const auto begin = text.find_first_not_of(" \n");
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const auto end = std::min(text.find_first_of(" \n"), text.size());
    words[count++] = text.substr(0, end);
    text.remove_prefix(end);
  }
  FlightLock lock;
  unsigned version = FlightLock::version;
  if (count > 3 && (!read_whole(words[3], version) || version != FlightLock::version))
    return std::unexpected{
        fmt::format("it is of version {}, this program's of version {}", words[3], FlightLock::version)};
  std::int64_t limit_ms = 0;
  if (count < 3 || count > 4 || !read_whole(words[0], lock.keeper) || lock.keeper <= 0 ||
      !read_whole(words[1], limit_ms) || limit_ms < 0)
    return std::unexpected{std::string{"it is no line of process, milliseconds, mission and version"}};
  lock.limit = std::chrono::milliseconds{std::min<std::int64_t>(limit_ms, longest_limit.count())};
  lock.mission = words[2];
  return lock;
}

}  // namespace hirosco::tools
