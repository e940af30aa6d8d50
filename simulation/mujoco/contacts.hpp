// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "simulation/mujoco/loose_bodies.hpp"
#include "simulation/mujoco/mujoco_spec.hpp"
#include "simulation/mujoco/mujoco_world.hpp"
#include "simulation/mujoco/robot_links.hpp"

namespace hirosco::simulation {

/// What touches in the world of a robot: how softly it gives way, how much of it is the robot's, and what is in each other.
/// Realtime: does not allocate but in overlap(). Thread: one.
class Contacts {
 public:
  /// What of the robot touches, and with how much in all across the surfaces.
  struct Touched {
    int contacts{0};
    double normal_n{0};
  };

  explicit Contacts(const MujocoSpec& spec) noexcept {
    if (spec.is_scene()) softness_s_.reset();
  }

  /// All that touches in this model gives way as here is set.
  void soften(mjModel& model) const noexcept;
  /// The time constant of it, without swinging; at least two sub-steps.
  void set_softness(double time_constant_s, MujocoWorld& world) noexcept;

  /// After a step; `bodies`: those that the world has.
  void feel(const MujocoWorld& world, const RobotLinks& links, const LooseBodies& bodies) noexcept;
  [[nodiscard]] const Touched& touched() const noexcept { return touched_; }
  /// What moves and is in what stands or lies around it; in words.
  [[nodiscard]] static std::optional<std::string> overlap(const MujocoWorld& world);

 private:
  /// Joints of this world do not give way: what gears and skins do stands in here. MuJoCo's own; none: each shape's, as its scene says.
  std::optional<double> softness_s_{0.02};
  Touched touched_;
};

}  // namespace hirosco::simulation
