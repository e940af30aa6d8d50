// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "robotics/dynamics/model.hpp"
#include "robotics/urdf/robot.hpp"
#include "tools/new_folder/equipment.hpp"
#include "tools/new_folder/kinds.hpp"

/// `hirosco new robot`: whether a URDF file can be flown as an arm, and what of its folder follows from it (docs/adr/0115).
namespace hirosco::tools {

/// What a drive moves besides its link, behind its gear, is guessed by its effort (subsystem's README), kg m2 or kg. The world of a simulated flight
/// takes no heavier rotor, ROTOR_INERTIA of a gripper no heavier one of a finger: efforts beyond are placeholders.
inline constexpr double effort_per_rotor = 300;
inline constexpr double most_rotor = 1000, most_finger_rotor = 100;

/// What is at the end of an arm: fingers that slide, a subsystem of their own.
struct NewGripper {
  std::vector<robotics::Model::Joint> joints;  ///< that drive them, in the order of the file
  std::string carrier;  ///< link at which they slide
  bool closed_is_upper{false};  ///< which ends of their ranges are nearer to each other
  double full_width_m{0};
  double most_force_n{0};  ///< that all of them press with
  double most_speed_m_s{0};  ///< of the gap
};

/// A robot that can be flown.
struct NewRobot {
  std::string name;  ///< as its file says
  std::string urdf;  ///< the file, as it is but for where its meshes are, and for what stands
  std::vector<std::pair<std::string, std::string>> meshes;  ///< beside it: names and octets
  robotics::Model model;  ///< of the arm: without what is the gripper's
  std::optional<NewGripper> hand;
  std::vector<std::string> world_joints;  ///< of both, in the order of the file
  std::string tip;  ///< link
  std::vector<double> posture;  ///< to begin with: within all ranges, held by the drives, clear of itself
  std::vector<double> goal;  ///< not far from it, likewise, as all between them
  double acceleration{
      0};  ///< of every joint at once, wherever the robot can hold itself, within what its file says; rad/s2 or m/s2
  double jerk{0};  ///< likewise; rad/s3 or m/s3
  double reach_m{0};  ///< of the tip, from the origin of the base
  double tip_z_m{0};  ///< in the posture to begin with
  std::vector<MarkSearch> marks{};  ///< of each joint, from that posture
  double wrist_range_n{0};
};

/// What is a gripper's of all `fingers`, joints of `whole` by their names, at an arm whose tool is the link `tip`, or whatever carries them where it
/// is empty. Nothing: `problem` was told why, of which joint, and what to do.
[[nodiscard]] std::optional<NewGripper> judge_gripper(
    const robotics::urdf::Robot& robot, const robotics::Model& whole, const std::vector<std::string>& fingers,
    const std::string& tip,
    const std::function<void(std::string_view joint, std::string message, std::string hint)>& problem);

struct JudgedRobot {
  std::optional<NewRobot> robot;  ///< only when `problems` is empty
  std::vector<descriptor::Diagnostic>
      problems;  ///< of the reader, and U06.. of what an arm needs besides (docs/urdf-errors.md)
  std::vector<descriptor::Diagnostic> warnings;
};

/// Reads the file strictly and judges what its reader leaves open: tip, drives, ranges, what MuJoCo refuses, whether it can hold itself.
/// `tip`: a link, or empty where only one end moves. `gripper`: joints (NAME,NAME) that are a subsystem of their own, at whose link the tool is
/// then where none is named; or empty. `packages`: folders in which those of its meshes lie. `chain`: only what moves tool and gripper is the robot's,
/// all other joints are fixed. Every posture that is looked at is the same at each call.
[[nodiscard]] JudgedRobot judge_robot(const std::filesystem::path& file, const descriptor::FileSource& source,
                                      const std::string& tip, const std::string& gripper = {},
                                      std::span<const std::filesystem::path> packages = {}, bool chain = false);

/// What of it stands in the templates, and the files that are its own: URDF and scene of the page.
[[nodiscard]] NewParts parts_of(const NewRobot& robot, const NewName& name, const Equipment& equipment = {});

}  // namespace hirosco::tools
