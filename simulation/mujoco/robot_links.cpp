// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/robot_links.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace hirosco::simulation {
namespace {

/// Of the robot's mass: nothing that touches resists more.
constexpr double heaviest_share = 10;

}  // namespace

void RobotLinks::find(const MujocoWorld& world, const JointDrives& drives, std::size_t robot, int first_loose) {
  const mjModel& model = world.model();
  const MujocoSpec& spec = world.spec();
  const MujocoSpec::Robot& its = spec.robots()[robot];
  robot_ = robot;
  of_robot_.assign(static_cast<std::size_t>(model.nbody), false);
  mass_.assign(model.body_mass, model.body_mass + first_loose);
  inertia_.assign(model.body_inertia, model.body_inertia + 3 * first_loose);
  for (int body = 1; body < first_loose; ++body) {
    const auto i = static_cast<std::size_t>(body);
    const bool its_own = spec.robot_of(model, body) == robot;
    of_robot_[i] = its.of_scene ? have(model.body_parentid[body]) || drives.move(body, model, its) : its_own;
    if (!its_own) mass_[i] = 0;
  }
}

void RobotLinks::weigh(MujocoWorld& world, std::span<const RobotLinks> robots) noexcept {
  mjModel& model = world.model();
  mjData& data = world.data();
  for (const RobotLinks& each : robots) each.give_masses(world);
  // It leaves the robots where their files have them at zero.
  const std::vector<double> where(data.qpos, data.qpos + model.nq), how_fast(data.qvel, data.qvel + model.nv);
  mj_setConst(&model, &data);
  for (const RobotLinks& each : robots) each.bound_contacts(model);
  std::ranges::copy(where, data.qpos);
  std::ranges::copy(how_fast, data.qvel);
  world.forward();
}

void RobotLinks::give_masses(MujocoWorld& world) const noexcept {
  mjModel& model = world.model();
  for (std::size_t body = 0; body < mass_.size(); ++body) {
    if (!of_robot_[body]) continue;
    model.body_mass[body] = mass_[body] * mass_factor_;
    for (std::size_t axis = 0; axis < 3; ++axis)
      model.body_inertia[3 * body + axis] = inertia_[3 * body + axis] * inertia_factor_;
  }
  if (const int tip = world.tip(robot_); tip > 0) model.body_mass[tip] = payload_kg_;
}

/// How softly a contact gives way MuJoCo reckons from what a link's centre resists in the first posture: of a link that turns about its own
/// centre that is beyond all bounds, and so would be its contacts.
void RobotLinks::bound_contacts(mjModel& model) const noexcept {
  const double heaviest_kg = heaviest_share * std::accumulate(mass_.begin(), mass_.end(), 0.0) * mass_factor_;
  if (!(heaviest_kg > 0)) return;
  for (int body = 0; body < static_cast<int>(mass_.size()); ++body)
    if (have_moved(body, model))
      model.body_invweight0[2 * body] = std::max(model.body_invweight0[2 * body], 1 / heaviest_kg);
}

}  // namespace hirosco::simulation
