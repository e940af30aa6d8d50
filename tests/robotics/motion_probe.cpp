// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <sstream>

#include "robotics/motion/point_to_point.hpp"

/// How long each motion takes: lines of a number of joints, then for each joint from, to, velocity, acceleration, jerk (ruckig_test.py).
int main() {
  using namespace hirosco::robotics;
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
    const auto plan = PointToPoint::plan(from, to, std::span{limits}.first(static_cast<std::size_t>(joints)));
    if (!in || !plan) return 2;
    fmt::print("{}\n", plan->duration_s());
  }
}
