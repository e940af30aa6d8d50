// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "robotics/shapes/collision.hpp"
#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics {

/// Joints of this robot that somebody else moves (a gripper's) stand for whoever carries what they move, and nobody tells him where (docs/adr/0194): each hull of a link that
/// they move becomes one of all places that their ranges let it be in, those of joints that follow them as well. It is in the link's frame with these
/// joints where urdf::fix() has them stand; as it was it is LinkHull::standing. `robot` is as its file says, before that.  Realtime: allocates, bounded by the number of hulls and joints.
void sweep(std::vector<LinkHull>& hulls, const urdf::Robot& robot, std::span<const std::string> standing);

}  // namespace hirosco::robotics
