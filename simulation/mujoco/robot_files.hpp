// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <map>
#include <string>
#include <string_view>

#include "hirosco/utilities/result.hpp"
#include "simulation/mujoco/mujoco_spec.hpp"

namespace hirosco::simulation {

/// Settings of a device that name its robot's URDF file, and an MJCF file which is its world then, or the robot that is mounted in another one.
inline constexpr std::string_view model_setting = "MODEL_FILE";
inline constexpr std::string_view world_file_setting = "WORLD_FILE";
[[nodiscard]] constexpr bool names_robot_file(std::string_view setting) {
  return setting == model_setting || setting == world_file_setting;
}

struct NoRobot {
  ErrorCode code{};
  std::string why;
};
/// What MuJoCo is told of these files, each by its setting's name; `mark` as of spec_of_urdf().  Realtime: allocates, reads files.
[[nodiscard]] std::expected<MujocoSpec, NoRobot> read_robot(const std::map<std::string, std::string>& files,
                                                            std::string_view mark = {});

}  // namespace hirosco::simulation
