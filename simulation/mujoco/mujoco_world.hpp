// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <expected>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <mujoco/mujoco.h>

#include "hirosco/utilities/time.hpp"
#include "simulation/mujoco/floating_base.hpp"
#include "simulation/mujoco/mujoco_spec.hpp"

namespace hirosco::simulation {

/// The world of robots as MuJoCo has it: what it was told, the model that was compiled of it, and how that stands. The first robot's base, and the tip of
/// each, which pushes and payloads act at. It becomes another one whenever something comes to it or goes; whoever keeps what is in a model looks there again.
/// Runge-Kutta of 4th order with sub-steps of at most 0.5 ms: the same bits twice from one version of MuJoCo on one architecture.
/// Realtime: compile(), become() and kinetic_energy_j() use the heap, nothing else does. Thread: one.
class MujocoWorld {
 public:
  /// Nothing is compiled yet, and only what says so may be called.
  explicit MujocoWorld(MujocoSpec spec) noexcept : spec_{std::move(spec)} {}

  /// What it is told.  Before it is compiled, too.
  [[nodiscard]] MujocoSpec& spec() noexcept { return spec_; }
  [[nodiscard]] const MujocoSpec& spec() const noexcept { return spec_; }

  /// What it may become.
  struct Compiled {
    MujocoModel model;
    MujocoData data;
  };
  /// What it is told, with these in it. In words why not.  Before it is compiled, too.
  [[nodiscard]] std::expected<Compiled, std::string> compile(std::span<const Obstacle> obstacles,
                                                             std::span<const LooseBody> bodies) const;
  /// The robot is at rest where its file has it at zero; gravity is as it was.  Before it is compiled, too.
  void become(Compiled next) noexcept;

  [[nodiscard]] mjModel& model() noexcept { return *model_; }
  [[nodiscard]] const mjModel& model() const noexcept { return *model_; }
  [[nodiscard]] mjData& data() const noexcept { return *data_; }
  [[nodiscard]] FloatingBase& base() noexcept { return base_; }
  [[nodiscard]] const FloatingBase& base() const noexcept { return base_; }

  /// The body that is a robot's tip; 0: it has none.
  [[nodiscard]] int tip(std::size_t robot) const noexcept { return tips_[robot]; }
  [[nodiscard]] std::span<const double, 3> tip_m(std::size_t robot) const noexcept;
  /// w x y z.
  [[nodiscard]] std::span<const double, 4> tip_orientation(std::size_t robot) const noexcept;
  /// What acts at it from outside until it is another: force in N, torque in N m, in the axes of the base.
  [[nodiscard]] std::span<double, 6> pushed(std::size_t robot) const noexcept;
  /// What hangs on it and pushes it gives to the link that carries it: force in N, moment in N m about its origin, in its own axes.
  [[nodiscard]] std::array<double, 6> tip_force(std::size_t robot) const noexcept;
  void push(std::array<double, 3> force_n, std::size_t robot) noexcept;
  void set_gravity(double x, double y, double z) noexcept;

  void step(Duration span) noexcept;
  /// What follows of how it stands is found out anew.
  void forward() noexcept { mj_forward(model_.get(), data_.get()); }
  /// What mimics a joint stands where it follows it to.
  void follow() noexcept;
  /// All is at rest where its files have it at zero.
  void reset() noexcept { mj_resetData(model_.get(), data_.get()); }
  [[nodiscard]] double kinetic_energy_j() const;

 private:
  MujocoSpec spec_;
  MujocoModel model_;
  MujocoData data_;
  FloatingBase base_;
  std::vector<int> tips_;  ///< robot by robot
};

}  // namespace hirosco::simulation
