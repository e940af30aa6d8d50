// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "robotics/dynamics/model.hpp"
#include "robotics/shapes/collision.hpp"
#include "tools/new_folder/kinds.hpp"

/// `hirosco new robot --homing --wrist-sensor`: what an arm may have that no URDF file tells of (docs/adr/0244).
namespace hirosco::tools {

struct NewRobot;

struct Equipment {
  bool homing{false};  ///< its joints look for their zeros themselves; it weighs nothing
  bool wrist_sensor{false};  ///< of force and moment, at its tip
};

/// How a joint looks for its mark, and where its world has that.
struct MarkSearch {
  double mark{0};  ///< rad or m
  double speed{0};  ///< rad/s or m/s, to the side of its sign
  double torque{0};  ///< N m or N
  double distance{0};  ///< rad or m
};
/// Of each joint, for an arm that stands there when it is switched on and finds its marks from the tip to the base: a second's way off, within its range, and
/// where the arm is clear of itself on the way to it, if there is such a side.
[[nodiscard]] std::vector<MarkSearch> find_marks(const robotics::Model& model,
                                                 std::span<const robotics::LinkHull> hulls,
                                                 const std::vector<double>& posture);

/// Of a sensor at this tip, N: as round as data sheets have it, and so small that what it takes for a contact is no more than a third of what any
/// joint does in this posture, from wherever it acts.
[[nodiscard]] double wrist_range_n(const robotics::Model& model, robotics::FrameId tip,
                                   const std::vector<double>& posture);

/// What of it stands in the templates, and which lines of them an arm without it does without.
void add_equipment(const NewRobot& robot, const Equipment& equipment, const NewName& name, NewParts& parts);

}  // namespace hirosco::tools
