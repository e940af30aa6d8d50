// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hirosco::simulation {

std::expected<MujocoWorld::Compiled, std::string> MujocoWorld::compile(std::span<const Obstacle> obstacles,
                                                                       std::span<const LooseBody> bodies) const {
  auto model = spec_.compile(obstacles, bodies);
  if (!model) return std::unexpected{std::move(model.error())};
  MujocoData data{mj_makeData(model->get())};
  if (data == nullptr) return std::unexpected{"MuJoCo has no memory for it"};
  const std::size_t of_base = spec_.floats() ? FloatingBase::dofs : 0;
  if (static_cast<std::size_t>((*model)->nv) !=
      spec_.joints().size() + spec_.further_dofs() + of_base + 6 * bodies.size())
    return std::unexpected{"MuJoCo has another number of joints than the file"};
  return Compiled{std::move(*model), std::move(data)};
}

void MujocoWorld::become(Compiled next) noexcept {
  if (model_ != nullptr) std::ranges::copy_n(model_->opt.gravity, 3, next.model->opt.gravity);
  if (spec_.floats()) base_.find(*next.model, spec_.root());
  model_ = std::move(next.model);
  data_ = std::move(next.data);
  tips_.clear();
  for (const MujocoSpec::Robot& robot : spec_.robots())
    tips_.push_back(
        std::max(0, mj_name2id(model_.get(), mjOBJ_BODY, (robot.prefix + MujocoSpec::payload_body).c_str())));
}

std::span<const double, 3> MujocoWorld::tip_m(std::size_t robot) const noexcept {
  return std::span<const double, 3>{data_->xpos + 3 * tip(robot), 3};
}

std::span<const double, 4> MujocoWorld::tip_orientation(std::size_t robot) const noexcept {
  return std::span<const double, 4>{data_->xquat + 4 * tip(robot), 4};
}

std::span<double, 6> MujocoWorld::pushed(std::size_t robot) const noexcept {
  return std::span<double, 6>{data_->xfrc_applied + 6 * tip(robot), 6};
}

std::array<double, 6> MujocoWorld::tip_force(std::size_t robot) const noexcept {
  mj_rnePostConstraint(model_.get(), data_.get());
  const int body = tip(robot);
  // What its carrier gives to it, about the centre of mass of all that moves: moment, force.
  std::array<double, 6> given{};
  mju_transformSpatial(given.data(), data_->cfrc_int + 6 * body, 1, data_->xpos + 3 * body,
                       data_->subtree_com + 3 * model_->body_rootid[body], data_->xmat + 9 * body);
  return {-given[3], -given[4], -given[5], -given[0], -given[1], -given[2]};
}

void MujocoWorld::push(std::array<double, 3> force_n, std::size_t robot) noexcept {
  std::ranges::copy(force_n, pushed(robot).begin());
}

void MujocoWorld::set_gravity(double x, double y, double z) noexcept {
  model_->opt.gravity[0] = x;
  model_->opt.gravity[1] = y;
  model_->opt.gravity[2] = z;
}

void MujocoWorld::step(Duration span) noexcept {
  if (base_.floats()) base_.apply(*data_);
  const auto steps =
      std::max<std::int64_t>(1, std::llround(std::ceil(seconds(span) / MujocoSpec::longest_sub_step_s - 1e-9)));
  model_->opt.timestep = seconds(span) / static_cast<double>(steps);
  for (std::int64_t i = 0; i < steps; ++i) mj_step(model_.get(), data_.get());
  // Once more, for the sensors: what stands there is of a stage within the last sub-step.
  forward();
}

void MujocoWorld::follow() noexcept {
  for (int i = 0; i < model_->neq; ++i) {
    if (model_->eq_type[i] != mjEQ_JOINT || model_->eq_obj2id[i] < 0) continue;
    const mjtNum* numbers = model_->eq_data + mjNEQDATA * i;
    data_->qpos[model_->jnt_qposadr[model_->eq_obj1id[i]]] =
        numbers[0] + numbers[1] * data_->qpos[model_->jnt_qposadr[model_->eq_obj2id[i]]];
  }
}

double MujocoWorld::kinetic_energy_j() const {
  std::vector<double> momentum(static_cast<std::size_t>(model_->nv));
  mj_mulM(model_.get(), data_.get(), momentum.data(), data_->qvel);
  return mju_dot(momentum.data(), data_->qvel, static_cast<int>(model_->nv)) / 2;
}

}  // namespace hirosco::simulation
