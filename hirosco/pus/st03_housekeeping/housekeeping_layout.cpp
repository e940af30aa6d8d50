// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/housekeeping_layout.hpp"

#include <algorithm>

namespace hirosco::pus {

HousekeepingLayout::HousekeepingLayout() {
  once_.reserve(most_listed);
  repeated_.reserve(most_repeated);
  sets_.reserve(most_listed);
}

void HousekeepingLayout::begin(std::span<const SampledValue> table, std::uint16_t new_id,
                               std::uint32_t new_interval) noexcept {
  table_ = table;
  id = new_id;
  interval = new_interval;
  once_.clear();
  repeated_.clear();
  sets_.clear();
  once_octets_ = 0;
}

bool HousekeepingLayout::add_once(std::size_t place) noexcept {
  if (once_.size() == most_listed) return false;
  once_.push_back(static_cast<std::uint32_t>(place));
  once_octets_ += table_[place].octets;
  return true;
}

bool HousekeepingLayout::begin_set(std::uint16_t repetitions) noexcept {
  if (sets_.size() == most_listed) return false;
  sets_.push_back({.repetitions = repetitions, .first = static_cast<std::uint16_t>(repeated_.size())});
  return true;
}

bool HousekeepingLayout::add_to_set(std::size_t place) noexcept {
  if (sets_.empty() || sets_.back().count == most_listed || repeated_.size() == most_repeated) return false;
  repeated_.push_back(static_cast<std::uint32_t>(place));
  ++sets_.back().count;
  sets_.back().octets += table_[place].octets;
  return true;
}

bool HousekeepingLayout::contains(std::size_t place) const noexcept {
  const auto has = [place](const std::vector<std::uint32_t>& values) {
    return std::ranges::find(values, place) != values.end();
  };
  return has(once_) || has(repeated_);
}

std::size_t HousekeepingLayout::report_octets() const noexcept {
  std::size_t sum = structure_id_octets + once_octets_;
  for (const Set& set : sets_) sum += std::size_t{set.repetitions} * set.octets;
  return sum;
}

bool HousekeepingLayout::allows(std::uint32_t cycles) const noexcept {
  return cycles != 0 && std::ranges::all_of(sets_, [cycles](const Set& set) {
           return set.repetitions != 0 && cycles % set.repetitions == 0;
         });
}

}  // namespace hirosco::pus
