// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulation/mujoco/loose_bodies.hpp"
#include "simulation/mujoco/mujoco_spec.hpp"
#include "simulation/mujoco/mujoco_world.hpp"
#include "simulation/mujoco/robot_links.hpp"

namespace hirosco::simulation {

/// What touches in a world of robots: how softly it gives way, how much of it is which robot's, and what is in each other.
/// Realtime: does not allocate but in overlap() and count_robots(). Thread: one.
class Contacts {
 public:
  /// What of a robot touches, and with how much in all across the surfaces.
  struct Touched {
    int contacts{0};
    double normal_n{0};
  };

  explicit Contacts(const MujocoSpec& spec) noexcept {
    if (spec.is_scene()) softness_s_.reset();
  }

  /// All that touches in a model of this gives way as here is set, but for what was mounted with a file that says it itself.
  void soften(mjModel& model, const MujocoSpec& spec) const noexcept;
  /// The time constant of it, without swinging; at least two sub-steps.
  void set_softness(double time_constant_s, MujocoWorld& world) noexcept;

  void count_robots(std::size_t robots) { touched_.assign(robots, Touched{}); }
  /// After a step; `robots`: as many as were counted; `bodies`: those that the world has.
  void feel(const MujocoWorld& world, std::span<const RobotLinks> robots, const LooseBodies& bodies) noexcept;
  [[nodiscard]] const Touched& touched(std::size_t robot) const noexcept { return touched_[robot]; }
  /// What moves and is in what stands or lies around it, or in another robot; in words.
  [[nodiscard]] static std::optional<std::string> overlap(const MujocoWorld& world);

 private:
  /// Joints give way where `springs` says so, and else not at all: what skins do, and gears then, stands in here. MuJoCo's own; none: each shape's, as its scene says.
  std::optional<double> softness_s_{0.02};
  std::vector<Touched> touched_{1};
};

}  // namespace hirosco::simulation
