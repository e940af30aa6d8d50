// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mount.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::size_t longest_name = 32;
constexpr double farthest_mount_m = 1000;
constexpr const char* mount_usage = "write NAME X,Y,Z [ROLL,PITCH,YAW]";

[[nodiscard]] bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= longest_name && std::ranges::all_of(text, [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '-';
  });
}

[[nodiscard]] std::expected<std::array<double, 3>, std::string> three_within(std::string_view what,
                                                                             std::string_view word, double most) {
  const auto numbers = listed_numbers(word);
  if (!numbers) return std::unexpected{fmt::format("{} '{}': {}; {}", what, word, numbers.error(), mount_usage)};
  if (numbers->size() != 3)
    return std::unexpected{fmt::format("{} '{}' has {} numbers, not 3; {}", what, word, numbers->size(), mount_usage)};
  if (std::ranges::any_of(*numbers, [&](double value) { return std::abs(value) > most; }))
    return std::unexpected{fmt::format("{} '{}' is not within {:g} to {:g}", what, word, -most, most)};
  return std::array{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

}  // namespace

std::expected<Mount, std::string> read_mount(std::span<const std::string_view> words) {
  if (words.size() < 2 || words.size() > 3)
    return std::unexpected{fmt::format("{} words say no mount: {}", words.size(), mount_usage)};
  if (!is_name(words[0]))
    return std::unexpected{fmt::format("'{}' names no robot: letters, digits, - and _, at most {}; {}", words[0],
                                       longest_name, mount_usage)};
  Mount mount{.name = std::string{words[0]}};
  const auto place = three_within("the place", words[1], farthest_mount_m);
  if (!place) return std::unexpected{place.error()};
  mount.place_m = *place;
  if (words.size() < 3) return mount;
  const auto turned = three_within("the turn", words[2], 2 * std::numbers::pi);
  if (!turned) return std::unexpected{turned.error()};
  mount.turned_rad = *turned;
  return mount;
}

}  // namespace hirosco::simulation
