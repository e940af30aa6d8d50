// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/standing.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::simulation {
namespace {

constexpr int free_positions = 7, free_velocities = 6;

}  // namespace

Standing::Standing(const MujocoWorld& world, const LooseBodies& bodies) {
  const mjData& data = world.data();
  const auto loose = static_cast<int>(bodies.count());
  const auto positions = world.model().nq - free_positions * loose,
             velocities = world.model().nv - free_velocities * loose;
  positions_.assign(data.qpos, data.qpos + positions);
  velocities_.assign(data.qvel, data.qvel + velocities);
  for (std::size_t robot = 0; robot < world.spec().robots().size(); ++robot)
    std::ranges::copy(world.pushed(robot), pushed_.emplace_back().begin());
  for (int i = 0; i < loose; ++i) {
    Body body{.name = bodies.name(static_cast<std::size_t>(i))};
    std::copy_n(data.qpos + positions + free_positions * i, free_positions, body.pose.begin());
    std::copy_n(data.qvel + velocities + free_velocities * i, free_velocities, body.velocity.begin());
    bodies_.push_back(std::move(body));
  }
}

void Standing::leave_out(std::string_view body) {
  std::erase_if(bodies_, [&](const Body& each) { return each.name == body; });
}

void Standing::take_joints_of(const Standing& other, const mjModel& model,
                              const std::function<bool(int body)>& of_these) {
  const auto take = [](std::vector<double>& to, const std::vector<double>& from, int at, int count) {
    for (auto i = static_cast<std::size_t>(at); i < static_cast<std::size_t>(at + count) && i < to.size(); ++i)
      to[i] = from[i];
  };
  for (int joint = 0; joint < model.njnt; ++joint) {
    if (!of_these(model.jnt_bodyid[joint])) continue;
    const bool floats = model.jnt_type[joint] == mjJNT_FREE, ball = model.jnt_type[joint] == mjJNT_BALL;
    take(positions_, other.positions_, model.jnt_qposadr[joint], floats ? free_positions : ball ? 4 : 1);
    take(velocities_, other.velocities_, model.jnt_dofadr[joint], floats ? free_velocities : ball ? 3 : 1);
  }
}

void Standing::restore(MujocoWorld& world, const LooseBodies& bodies) const noexcept {
  mjData& data = world.data();
  std::ranges::copy(positions_, data.qpos);
  std::ranges::copy(velocities_, data.qvel);
  for (std::size_t robot = 0; robot < std::min(pushed_.size(), world.spec().robots().size()); ++robot)
    std::ranges::copy(pushed_[robot], world.pushed(robot).begin());
  const auto loose = static_cast<int>(bodies.count());
  const auto positions = world.model().nq - free_positions * loose,
             velocities = world.model().nv - free_velocities * loose;
  for (int i = 0; i < loose; ++i) {
    const auto found = std::ranges::find(bodies_, bodies.name(static_cast<std::size_t>(i)), &Body::name);
    if (found == bodies_.end()) continue;
    std::ranges::copy(found->pose, data.qpos + positions + free_positions * i);
    std::ranges::copy(found->velocity, data.qvel + velocities + free_velocities * i);
  }
}

}  // namespace hirosco::simulation
