// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/mujoco/loose_bodies.hpp"
#include "simulation/mujoco/mujoco_world.hpp"

namespace hirosco::simulation {

/// How what moves in a world of robots stands, and what pushes their tips, so that it goes on in another model of the same ones, or of more.
/// Realtime: to take it down allocates, to restore it does not. Thread: one.
class Standing {
 public:
  /// `bodies`: those that the world has.
  Standing(const MujocoWorld& world, const LooseBodies& bodies);
  /// The loose body of this name is where it begins.
  void leave_out(std::string_view body);
  /// Loose bodies are where they are there.
  void take_bodies_of(const Standing& other) { bodies_ = other.bodies_; }
  /// Joints that move bodies of these stand and move as they do there. `of_these`: by bodies of `model`, which both are of.
  void take_joints_of(const Standing& other, const mjModel& model, const std::function<bool(int body)>& of_these);
  /// Whatever body of that world is not in it stays where it is, and so does a robot that is not.
  void restore(MujocoWorld& world, const LooseBodies& bodies) const noexcept;

 private:
  struct Body {
    std::string name{};
    std::array<double, 7> pose{};
    std::array<double, 6> velocity{};
  };
  std::vector<double> positions_, velocities_;  ///< of the robots
  std::vector<std::array<double, 6>> pushed_;
  std::vector<Body> bodies_;
};

}  // namespace hirosco::simulation
