// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "simulation/mujoco/mujoco_robot.hpp"

/// Bodies that move by themselves: in a model they come behind all that is the robot's.
namespace hirosco::simulation {
namespace {

constexpr int free_positions = 7, free_velocities = 6;

[[nodiscard]] auto named(std::vector<LooseBody>& bodies, std::string_view name) {
  return std::ranges::find(bodies, name, [](const LooseBody& body) -> std::string_view { return body.standing.name; });
}

}  // namespace

MujocoRobot::Standing MujocoRobot::standing() const {
  const auto loose = static_cast<int>(bodies_.size());
  const auto positions = model_->nq - free_positions * loose, velocities = model_->nv - free_velocities * loose;
  Standing now{.positions = {data_->qpos, data_->qpos + positions},
               .velocities = {data_->qvel, data_->qvel + velocities}};
  std::copy_n(data_->xfrc_applied + 6 * tip_, 6, now.pushed.begin());
  for (int i = 0; i < loose; ++i) {
    Standing::Body body{.name = bodies_[static_cast<std::size_t>(i)].standing.name};
    std::copy_n(data_->qpos + positions + free_positions * i, free_positions, body.pose.begin());
    std::copy_n(data_->qvel + velocities + free_velocities * i, free_velocities, body.velocity.begin());
    now.bodies.push_back(std::move(body));
  }
  return now;
}

void MujocoRobot::stand(const Standing& standing) noexcept {
  std::ranges::copy(standing.positions, data_->qpos);
  std::ranges::copy(standing.velocities, data_->qvel);
  std::ranges::copy(standing.pushed, data_->xfrc_applied + 6 * tip_);
  const auto loose = static_cast<int>(bodies_.size());
  const auto positions = model_->nq - free_positions * loose, velocities = model_->nv - free_velocities * loose;
  for (int i = 0; i < loose; ++i) {
    const auto found =
        std::ranges::find(standing.bodies, bodies_[static_cast<std::size_t>(i)].standing.name, &Standing::Body::name);
    if (found == standing.bodies.end()) continue;
    std::ranges::copy(found->pose, data_->qpos + positions + free_positions * i);
    std::ranges::copy(found->velocity, data_->qvel + velocities + free_velocities * i);
  }
  pull_bodies();
  mj_forward(model_.get(), data_.get());
  feel();
}

void MujocoRobot::pull_bodies() noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    std::ranges::copy(pulled_n_[i], data_->xfrc_applied + 6 * (first_body() + static_cast<int>(i)));
}

std::expected<void, std::string> MujocoRobot::lay(const LooseBody& body) {
  std::vector<LooseBody> all = bodies_;
  if (const auto found = named(all, body.standing.name); found != all.end()) *found = body;
  else if (all.size() == most_bodies) return std::unexpected{fmt::format("there are {} bodies", most_bodies)};
  else all.push_back(body);
  return surround(obstacles_, std::move(all), body.standing.name);
}

std::expected<void, std::string> MujocoRobot::take_body_away(std::string_view name) {
  std::vector<LooseBody> all = bodies_;
  const auto found = named(all, name);
  if (found == all.end()) return std::unexpected{fmt::format("there is no body '{}'", name)};
  all.erase(found);
  return surround(obstacles_, std::move(all));
}

bool MujocoRobot::pull(std::string_view name, std::array<double, 3> force_n) noexcept {
  const auto found = named(bodies_, name);
  if (found == bodies_.end()) return false;
  pulled_n_[static_cast<std::size_t>(found - bodies_.begin())] = force_n;
  pull_bodies();
  return true;
}

void MujocoRobot::let_go_of_bodies() noexcept {
  std::ranges::fill(pulled_n_, std::array<double, 3>{});
  pull_bodies();
}

MujocoRobot::BodyTruth MujocoRobot::body(std::size_t index) const noexcept {
  const int id = first_body() + static_cast<int>(index);
  BodyTruth truth{.name = bodies_[index].standing.name};
  std::copy_n(data_->xpos + 3 * id, 3, truth.place_m.begin());
  std::copy_n(data_->xquat + 4 * id, 4, truth.turned_wxyz.begin());
  std::copy_n(data_->qvel + model_->body_dofadr[id], 3, truth.velocity_m_s.begin());
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (contact.efc_address < 0) continue;
    const int one = model_->geom_bodyid[contact.geom[0]], other = model_->geom_bodyid[contact.geom[1]];
    const int by = one == id ? other : other == id ? one : -1;
    if (by < 0 || !is_of_robot(by) || model_->body_weldid[by] == 0) continue;
    std::array<mjtNum, 6> wrench{};
    mj_contactForce(model_.get(), data_.get(), i, wrench.data());
    truth.pressed_n += wrench[0];
  }
  return truth;
}

}  // namespace hirosco::simulation
