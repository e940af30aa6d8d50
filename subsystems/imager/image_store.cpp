// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/image_store.hpp"

#include <algorithm>
#include <functional>

namespace hirosco::imager {

std::array<std::uint32_t, ImageStore::places> ImageStore::numbers() const noexcept {
  std::array<std::uint32_t, places> found{};
  std::ranges::transform(places_, found.begin(), [](const Place& place) { return place.number.load(); });
  std::ranges::sort(found);
  std::ranges::rotate(found, std::ranges::find_if(found, [](std::uint32_t number) { return number != 0; }));
  return found;
}

std::optional<ImageStore::Held> ImageStore::hold(std::uint32_t number) const noexcept {
  if (number == 0) number = std::ranges::max(numbers());
  if (number == 0) return std::nullopt;
  for (std::size_t i = 0; i < places; ++i) {
    if (places_[i].number.load() != number) continue;
    places_[i].readers.fetch_add(1);
    Held held{*this, i};
    if (places_[i].number.load() == number) return held;
  }
  return std::nullopt;
}

}  // namespace hirosco::imager
