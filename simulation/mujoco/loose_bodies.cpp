// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/loose_bodies.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {

std::optional<std::size_t> LooseBodies::named(std::string_view name) const noexcept {
  const auto found =
      std::ranges::find(bodies_, name, [](const LooseBody& body) -> std::string_view { return body.standing.name; });
  if (found == bodies_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - bodies_.begin());
}

std::expected<LooseBodies, std::string> LooseBodies::with(const LooseBody& body) const {
  LooseBodies all = *this;
  if (const auto index = named(body.standing.name)) {
    all.bodies_[*index] = body;
    all.pulled_n_[*index] = {};
    return all;
  }
  if (count() == most_bodies) return std::unexpected{fmt::format("there are {} bodies", most_bodies)};
  all.bodies_.push_back(body);
  all.pulled_n_.push_back({});
  return all;
}

std::expected<LooseBodies, std::string> LooseBodies::without(std::string_view name) const {
  const auto index = named(name);
  if (!index) return std::unexpected{fmt::format("there is no body '{}'", name)};
  LooseBodies all = *this;
  all.bodies_.erase(all.bodies_.begin() + static_cast<std::ptrdiff_t>(*index));
  all.pulled_n_.erase(all.pulled_n_.begin() + static_cast<std::ptrdiff_t>(*index));
  return all;
}

bool LooseBodies::pull(std::string_view name, std::array<double, 3> force_n, MujocoWorld& world) noexcept {
  const auto index = named(name);
  if (!index) return false;
  pulled_n_[*index] = force_n;
  apply(world);
  return true;
}

void LooseBodies::let_go(MujocoWorld& world) noexcept {
  std::ranges::fill(pulled_n_, std::array<double, 3>{});
  apply(world);
}

void LooseBodies::apply(MujocoWorld& world) const noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    std::ranges::copy(pulled_n_[i], world.data().xfrc_applied + 6 * (first(world.model()) + static_cast<int>(i)));
}

LooseBodies::Truth LooseBodies::truth(std::size_t index, const MujocoWorld& world,
                                      std::span<const RobotLinks> robots) const noexcept {
  const mjModel& model = world.model();
  const mjData& data = world.data();
  const int id = first(model) + static_cast<int>(index);
  Truth truth{.name = name(index)};
  std::copy_n(data.xpos + 3 * id, 3, truth.place_m.begin());
  std::copy_n(data.xquat + 4 * id, 4, truth.turned_wxyz.begin());
  std::copy_n(data.qvel + model.body_dofadr[id], 3, truth.velocity_m_s.begin());
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    if (contact.efc_address < 0) continue;
    const int one = model.geom_bodyid[contact.geom[0]], other = model.geom_bodyid[contact.geom[1]];
    const int by = one == id ? other : other == id ? one : -1;
    const auto have_moved = [&](const RobotLinks& links) { return links.have_moved(by, model); };
    if (by < 0 || std::ranges::none_of(robots, have_moved)) continue;
    std::array<mjtNum, 6> wrench{};
    mj_contactForce(&model, &data, i, wrench.data());
    truth.pressed_n += wrench[0];
  }
  return truth;
}

}  // namespace hirosco::simulation
