// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/mujoco/loose_bodies.hpp"
#include "simulation/mujoco/mujoco_world.hpp"

namespace hirosco::simulation {

/// How what moves in the world of a robot stands, and what pushes its tip, so that it goes on in another model of the same robot.
/// Realtime: to take it down allocates, to restore it does not. Thread: one.
class Standing {
 public:
  /// `bodies`: those that the world has.
  Standing(const MujocoWorld& world, const LooseBodies& bodies);
  /// The loose body of this name is where it begins.
  void leave_out(std::string_view body);
  /// Loose bodies are where they are there.
  void take_bodies_of(const Standing& other) { bodies_ = other.bodies_; }
  /// Whatever body of that world is not in it stays where it is.
  void restore(MujocoWorld& world, const LooseBodies& bodies) const noexcept;

 private:
  struct Body {
    std::string name{};
    std::array<double, 7> pose{};
    std::array<double, 6> velocity{};
  };
  std::vector<double> positions_, velocities_;  ///< of the robot
  std::array<double, 6> pushed_{};
  std::vector<Body> bodies_;
};

}  // namespace hirosco::simulation
