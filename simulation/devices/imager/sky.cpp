// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/imager/sky.hpp"

#include <algorithm>
#include <cstdlib>

namespace hirosco::simulation {
namespace {

constexpr std::uint32_t brightest = 255;
/// The sky is made of squares of so many elements; every other one has a star.
constexpr std::int64_t square = 64;
/// How far a star's light goes, in elements, and what of it falls where, by the square of the distance, in sixteenths.
constexpr std::int64_t reach = 2;
constexpr std::array<std::uint32_t, 9> spread{16, 9, 5, 0, 3, 1, 0, 0, 0};

/// splitmix64.
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t value) noexcept {
  value += 0x9E37'79B9'7F4A'7C15;
  value = (value ^ (value >> 30)) * 0xBF58'476D'1CE4'E5B9;
  value = (value ^ (value >> 27)) * 0x94D0'49BB'1331'11EB;
  return value ^ (value >> 31);
}

[[nodiscard]] constexpr std::int64_t square_of(std::int64_t at) noexcept {
  return (at - (at < 0 ? square - 1 : 0)) / square;
}

}  // namespace

void Sky::add(std::int64_t x, std::int64_t y, std::uint32_t counts) noexcept {
  if (x < 0 || y < 0 || x >= sensor_pixels || y >= sensor_pixels) return;
  std::uint8_t& element = sensor_[static_cast<std::size_t>(y * sensor_pixels + x)];
  element = static_cast<std::uint8_t>(std::min(element + counts, brightest));
}

void Sky::add_stars(const Shot& shot) noexcept {
  const std::int64_t last_u = square_of(shot.u + sensor_pixels + reach),
                     last_v = square_of(shot.v + sensor_pixels + reach);
  for (std::int64_t j = square_of(shot.v - reach); j <= last_v; ++j)
    for (std::int64_t i = square_of(shot.u - reach); i <= last_u; ++i) {
      const auto low = static_cast<std::uint32_t>(j);
      const std::uint64_t star = mixed(mixed(shot.sky) ^ (static_cast<std::uint64_t>(i) << 32 | low));
      if ((star & 1) == 0) continue;
      const auto x = i * square + static_cast<std::int64_t>(star >> 8 & 63) - shot.u;
      const auto y = j * square + static_cast<std::int64_t>(star >> 16 & 63) - shot.v;
      const std::uint64_t magnitude = star >> 24 & 255;
      // Few are bright. Counts of a millisecond in the middle: 1 to 254.
      const std::uint64_t a_ms = 1 + (magnitude * magnitude * magnitude >> 16);
      const std::uint64_t counts = a_ms * shot.exposure_us / 1000;
      for (std::int64_t b = -reach; b <= reach; ++b)
        for (std::int64_t a = -reach; a <= reach; ++a)
          add(x + a, y + b,
              static_cast<std::uint32_t>(
                  std::min<std::uint64_t>(counts * spread[static_cast<std::size_t>(a * a + b * b)] / 16, brightest)));
    }
}

std::span<const std::uint8_t> Sky::expose(const Shot& shot) noexcept {
  std::ranges::fill(sensor_, static_cast<std::uint8_t>(std::min(shot.dark_counts, brightest)));
  if (shot.shutter) add_stars(shot);
  if (shot.noise != 0)
    for (std::size_t at = 0; at < sensor_.size(); ++at) {
      const std::uint64_t here = mixed(static_cast<std::uint64_t>(shot.number) << 32 | at);
      sensor_[at] =
          static_cast<std::uint8_t>(std::min<std::uint64_t>(sensor_[at] + here % (shot.noise + 1), brightest));
    }
  for (std::uint32_t i = 0; i < shot.hot; ++i) {
    const std::uint64_t where = mixed(shot.sky + 0x484F'5400 + i);
    sensor_[(where >> 16) % sensor_pixels * sensor_pixels + where % sensor_pixels] = brightest;
  }
  const SensorWindow& window = shot.window;
  std::size_t at = 0;
  for (std::uint32_t y = window.y; y < window.y + window.height; y += window.binning)
    for (std::uint32_t x = window.x; x < window.x + window.width; x += window.binning) {
      std::uint32_t sum = 0;
      for (std::uint32_t b = 0; b < window.binning; ++b)
        for (std::uint32_t a = 0; a < window.binning; ++a) sum += sensor_[std::size_t{y + b} * sensor_pixels + x + a];
      const auto value = static_cast<std::uint8_t>(std::min(sum, brightest));
      image_[at++] = value < shot.threshold ? std::uint8_t{0} : value;
    }
  return std::span{image_}.first(at);
}

}  // namespace hirosco::simulation
