// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/robot_files.hpp"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "hirosco/descriptor/read/read.hpp"
#include "simulation/mujoco/mujoco_scene.hpp"
#include "simulation/mujoco/mujoco_urdf.hpp"

namespace hirosco::simulation {

std::expected<MujocoSpec, NoRobot> read_robot(const std::map<std::string, std::string>& files, std::string_view mark) {
  const auto robot = files.find(std::string{model_setting}), scene = files.find(std::string{world_file_setting});
  if (robot == files.end())
    return std::unexpected{
        NoRobot{ErrorCode::NotFound, "the descriptor names no URDF file: setting MODEL_FILE of the device"}};
  const auto read = [](const std::filesystem::path& file) -> std::expected<std::string, std::string> {
    auto octets = descriptor::file_system()(file);
    if (!octets) return std::unexpected{octets.error().text};
    return std::move(*octets);
  };
  const auto not_there = [](const std::string& file, const std::string& why) {
    return std::unexpected{NoRobot{ErrorCode::NotFound, fmt::format("{} {}", file, why)}};
  };
  const auto& world = scene != files.end() ? scene->second : robot->second;
  const MeshSource beside = [&](const std::string& file) {
    return read((std::filesystem::path{world}.parent_path() / file).lexically_normal());
  };
  const auto malformed = [&](const std::string& why) {
    return std::unexpected{NoRobot{ErrorCode::Malformed, fmt::format("{}: {}", world, why)}};
  };
  const auto urdf = read(robot->second);
  if (!urdf) return not_there(robot->second, urdf.error());
  if (scene == files.end()) {
    auto spec = spec_of_urdf(*urdf, beside, mark);
    if (!spec) return malformed(spec.error());
    return std::move(*spec);
  }
  const auto mjcf = read(scene->second);
  if (!mjcf) return not_there(scene->second, mjcf.error());
  auto joints = driven_joints(*urdf);
  if (!joints) return malformed(joints.error());
  auto spec = spec_of_scene(*mjcf, std::move(*joints), beside, mark);
  if (!spec) return malformed(spec.error());
  return std::move(*spec);
}

}  // namespace hirosco::simulation
