// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <sstream>
#include <string_view>

#include "robotics/motion/point_to_point.hpp"

/// How long each motion takes, `straight` from posture to posture or with a curve for each joint: lines of a number of joints, then for each joint from,
/// to, velocity, acceleration, jerk (ruckig_test.py).
int main(int argc, char** argv) {
  using namespace hirosco::robotics;
  const bool straight = argc > 1 && std::string_view{argv[1]} == "straight";
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream in{line};
    int joints = 0;
    in >> joints;
    if (!in || joints < 1 || joints > max_joints) return 2;
    JointVector from(joints), to(joints);
    std::array<MotionLimits, max_joints> limits;
    for (int i = 0; i < joints; ++i) {
      auto& its = limits[static_cast<std::size_t>(i)];
      in >> from[i] >> to[i] >> its.velocity >> its.acceleration >> its.jerk;
    }
    const auto plan = (straight ? PointToPoint::plan_straight : PointToPoint::plan)(
        from, to, std::span{limits}.first(static_cast<std::size_t>(joints)));
    if (!in || !plan) return 2;
    fmt::print("{}\n", plan->duration_s());
  }
}
