// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/mujoco/mujoco_world.hpp"
#include "simulation/mujoco/robot_links.hpp"
#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {

/// What lies around a robot and moves by itself, and what each of them is pulled by. In a model they come behind all that is the
/// robot's. A value: with() and without() make others, which a world has once it is compiled with them.
/// Realtime: these two and copies allocate, nothing else does. Thread: one.
class LooseBodies {
 public:
  /// In place of the one of this name, if there is one, and pulled by nothing. In words why not: too many.
  [[nodiscard]] std::expected<LooseBodies, std::string> with(const LooseBody& body) const;
  /// In words why not: there is none of this name.
  [[nodiscard]] std::expected<LooseBodies, std::string> without(std::string_view name) const;

  [[nodiscard]] std::span<const LooseBody> all() const noexcept { return bodies_; }
  [[nodiscard]] std::size_t count() const noexcept { return bodies_.size(); }
  [[nodiscard]] const std::string& name(std::size_t index) const noexcept { return bodies_[index].standing.name; }
  /// The first of them in a model that has them.
  [[nodiscard]] int first(const mjModel& model) const noexcept {
    return static_cast<int>(model.nbody) - static_cast<int>(bodies_.size());
  }

  /// A force at its centre, N, in the axes of the base, until it is another. False: there is no such body.
  [[nodiscard]] bool pull(std::string_view name, std::array<double, 3> force_n, MujocoWorld& world) noexcept;
  void let_go(MujocoWorld& world) noexcept;
  /// What they are pulled by acts on them.
  void apply(MujocoWorld& world) const noexcept;

  /// Of one of them; in the axes of the base.
  struct Truth {
    std::string_view name;
    std::array<double, 3> place_m{};  ///< of its centre
    std::array<double, 4> turned_wxyz{};
    std::array<double, 3> velocity_m_s{};
    double pressed_n{0};  ///< by links of robots, in all across the surfaces
  };
  [[nodiscard]] Truth truth(std::size_t index, const MujocoWorld& world,
                            std::span<const RobotLinks> robots) const noexcept;

 private:
  [[nodiscard]] std::optional<std::size_t> named(std::string_view name) const noexcept;

  std::vector<LooseBody> bodies_;
  std::vector<std::array<double, 3>> pulled_n_;  ///< each of them
};

}  // namespace hirosco::simulation
