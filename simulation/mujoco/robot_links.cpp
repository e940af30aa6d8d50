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

void RobotLinks::find(const MujocoWorld& world, const JointDrives& drives, int first_loose) {
  const mjModel& model = world.model();
  of_robot_.assign(static_cast<std::size_t>(model.nbody), false);
  for (int body = 1; body < first_loose; ++body)
    of_robot_[static_cast<std::size_t>(body)] =
        !world.spec().is_scene() || have(model.body_parentid[body]) || drives.move(body, model);
  mass_.assign(model.body_mass, model.body_mass + first_loose);
  inertia_.assign(model.body_inertia, model.body_inertia + 3 * first_loose);
}

void RobotLinks::weigh(MujocoWorld& world) const noexcept {
  mjModel& model = world.model();
  mjData& data = world.data();
  const auto first_loose = static_cast<int>(mass_.size());
  for (int body = 0; body < first_loose; ++body) {
    const auto i = static_cast<std::size_t>(body);
    if (!have(body)) continue;
    model.body_mass[body] = mass_[i] * mass_factor_;
    for (std::size_t axis = 0; axis < 3; ++axis)
      model.body_inertia[3 * i + axis] = inertia_[3 * i + axis] * inertia_factor_;
  }
  if (world.tip() > 0) model.body_mass[world.tip()] = payload_kg_;
  // It leaves the robot where its file has it at zero.
  const std::vector<double> where(data.qpos, data.qpos + model.nq), how_fast(data.qvel, data.qvel + model.nv);
  mj_setConst(&model, &data);
  // How softly a contact gives way MuJoCo reckons from what a link's centre resists in the first posture: of a link that turns about its
  // own centre that is beyond all bounds, and so would be its contacts.
  const double heaviest_kg = heaviest_share * std::accumulate(mass_.begin(), mass_.end(), 0.0) * mass_factor_;
  for (int body = 0; body < first_loose; ++body)
    if (have_moved(body, model) && heaviest_kg > 0)
      model.body_invweight0[2 * body] = std::max(model.body_invweight0[2 * body], 1 / heaviest_kg);
  std::ranges::copy(where, data.qpos);
  std::ranges::copy(how_fast, data.qvel);
  world.forward();
}

}  // namespace hirosco::simulation
