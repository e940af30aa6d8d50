// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/book.hpp"

#include <algorithm>
#include <limits>

namespace hirosco::supervisor {

std::optional<Shortage> Book::shortage(std::uint16_t holder, std::uint32_t amount,
                                       std::uint32_t budget) const noexcept {
  if (amount == 0) return std::nullopt;
  const std::uint32_t others = reserved() - held(holder);
  if (std::uint64_t{others} + amount <= budget) return std::nullopt;
  return Shortage{.budget = budget, .reserved = others, .requested = amount};
}

void Book::hold(std::uint16_t holder, std::uint32_t amount) {
  const auto found = std::ranges::find(entries_, holder, &Entry::holder);
  if (amount == 0) {
    if (found != entries_.end()) entries_.erase(found);
  } else if (found != entries_.end()) {
    found->amount = amount;
  } else {
    entries_.push_back({holder, amount});
  }
}

std::uint32_t Book::reserved() const noexcept {
  std::uint64_t sum = 0;
  for (const Entry& entry : entries_) sum += entry.amount;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(sum, std::numeric_limits<std::uint32_t>::max()));
}

std::uint32_t Book::held(std::uint16_t holder) const noexcept {
  const auto found = std::ranges::find(entries_, holder, &Entry::holder);
  return found == entries_.end() ? 0 : found->amount;
}

}  // namespace hirosco::supervisor
