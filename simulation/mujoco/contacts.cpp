// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/contacts.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

/// Deeper than what presses can come: it was put into what is there already.
constexpr double within_m = 0.005;

}  // namespace

void Contacts::soften(mjModel& model, const MujocoSpec& spec) const noexcept {
  for (int geom = 0; softness_s_ && geom < model.ngeom; ++geom) {
    const std::size_t robot = spec.robot_of(model, model.geom_bodyid[geom]);
    if (robot == 0 || !spec.robots()[robot].of_scene) model.geom_solref[mjNREF * geom] = *softness_s_;
  }
}

void Contacts::set_softness(double time_constant_s, MujocoWorld& world) noexcept {
  softness_s_ = time_constant_s;
  soften(world.model(), world.spec());
}

void Contacts::feel(const MujocoWorld& world, std::span<const RobotLinks> robots, const LooseBodies& bodies) noexcept {
  const mjModel& model = world.model();
  const mjData& data = world.data();
  std::ranges::fill(touched_, Touched{});
  const bool others_touch = world.spec().is_scene() || bodies.count() > 0 || robots.size() > 1;
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    if (contact.efc_address < 0) continue;
    std::array<mjtNum, 6> wrench{};
    mj_contactForce(&model, &data, i, wrench.data());
    for (std::size_t robot = 0; robot < std::min(robots.size(), touched_.size()); ++robot) {
      const auto its = [&](int geom) { return robots[robot].have_moved(model.geom_bodyid[geom], model); };
      if (others_touch && !its(contact.geom[0]) && !its(contact.geom[1])) continue;
      ++touched_[robot].contacts;
      touched_[robot].normal_n += wrench[0];
    }
  }
}

namespace {

[[nodiscard]] std::string_view link_of(const mjModel& model, int geom) noexcept {
  const char* name = mj_id2name(&model, mjOBJ_BODY, model.geom_bodyid[geom]);
  return name != nullptr ? name : "";
}

}  // namespace

std::optional<std::string> Contacts::overlap(const MujocoWorld& world) {
  const mjModel& model = world.model();
  for (int i = 0; i < world.data().ncon; ++i) {
    const mjContact& contact = world.data().contact[i];
    if (contact.dist > -within_m) continue;
    for (const auto& [geom, other] :
         {std::pair{contact.geom[0], contact.geom[1]}, {contact.geom[1], contact.geom[0]}}) {
      const std::string_view obstacle = MujocoSpec::obstacle_of(model, geom);
      const std::string_view into = obstacle.empty() ? MujocoSpec::loose_body_of(model, geom) : obstacle;
      const std::string_view body = MujocoSpec::loose_body_of(model, other);
      if (into.empty()) continue;
      return fmt::format("{} '{}' stands in {} '{}', {:.0f} mm deep", body.empty() ? "link" : "body",
                         !body.empty() ? body : link_of(model, other), obstacle.empty() ? "body" : "obstacle", into,
                         -1e3 * contact.dist);
    }
    const auto robot = [&](int geom) { return world.spec().robot_of(model, model.geom_bodyid[geom]); };
    if (robot(contact.geom[0]) != robot(contact.geom[1]))
      return fmt::format("link '{}' stands in link '{}', {:.0f} mm deep", link_of(model, contact.geom[0]),
                         link_of(model, contact.geom[1]), -1e3 * contact.dist);
  }
  return std::nullopt;
}

}  // namespace hirosco::simulation
