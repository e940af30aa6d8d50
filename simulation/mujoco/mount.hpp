// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <expected>
#include <span>
#include <string>
#include <string_view>

/// Where a further robot stands in the world of another one. No MuJoCo here.
namespace hirosco::simulation {

struct Mount {
  std::string name;  ///< what its links and joints are called by there: NAME/LINK, NAME/JOINT
  std::array<double, 3> place_m{};  ///< in the axes of the first robot's base, of one that floats where it begins
  std::array<double, 3> turned_rad{};  ///< about x, then y, then z of these axes, as a URDF file's rpy

  [[nodiscard]] std::string prefix() const { return name + "/"; }
};
/// In one world, with the one whose world it is.
inline constexpr std::size_t most_robots = 8;

/// `words`: NAME X,Y,Z [ROLL,PITCH,YAW]. In words what is wrong.  Realtime: allocates.
[[nodiscard]] std::expected<Mount, std::string> read_mount(std::span<const std::string_view> words);

}  // namespace hirosco::simulation
