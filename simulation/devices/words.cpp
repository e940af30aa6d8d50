// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace hirosco::simulation {

Words::Words(std::string_view line) noexcept {
  constexpr std::string_view blank = " \t\r\n";
  while (true) {
    const auto start = line.find_first_not_of(blank);
    if (start == std::string_view::npos) return;
    line.remove_prefix(start);
    const auto length = std::min(line.find_first_of(blank), line.size());
    if (count_ == words_.size()) {
      too_many_ = true;
      return;
    }
    words_[count_++] = line.substr(0, length);
    line.remove_prefix(length);
  }
}

Result<double> Words::number(std::size_t i, double low, double high) const noexcept {
  const std::string_view word = (*this)[i];
  double value = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (problem != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
    return fail(ErrorCode::InvalidArgument, "not a number", static_cast<std::int64_t>(i));
  if (value < low || value > high) return fail(ErrorCode::OutOfRange, "number", static_cast<std::int64_t>(i));
  return value;
}

Result<> Words::expect(std::size_t expected) const noexcept {
  if (too_many_ || count_ != expected)
    return fail(ErrorCode::InvalidArgument, "wrong number of words", static_cast<std::int64_t>(count_));
  return ok();
}

}  // namespace hirosco::simulation
