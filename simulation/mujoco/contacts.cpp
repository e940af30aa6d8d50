// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/contacts.hpp"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

/// Deeper than what presses can come: it was put into what is there already.
constexpr double within_m = 0.005;

}  // namespace

void Contacts::soften(mjModel& model) const noexcept {
  for (int geom = 0; softness_s_ && geom < model.ngeom; ++geom) model.geom_solref[mjNREF * geom] = *softness_s_;
}

void Contacts::set_softness(double time_constant_s, MujocoWorld& world) noexcept {
  softness_s_ = time_constant_s;
  soften(world.model());
}

void Contacts::feel(const MujocoWorld& world, const RobotLinks& links, const LooseBodies& bodies) noexcept {
  const mjModel& model = world.model();
  const mjData& data = world.data();
  touched_ = {};
  const auto of_robot = [&](int geom) { return links.have_moved(model.geom_bodyid[geom], model); };
  const bool others_touch = world.spec().is_scene() || bodies.count() > 0;
  for (int i = 0; i < data.ncon; ++i) {
    if (data.contact[i].efc_address < 0) continue;
    if (others_touch && !of_robot(data.contact[i].geom[0]) && !of_robot(data.contact[i].geom[1])) continue;
    std::array<mjtNum, 6> wrench{};
    mj_contactForce(&model, &data, i, wrench.data());
    ++touched_.contacts;
    touched_.normal_n += wrench[0];
  }
}

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
      const char* link = mj_id2name(&model, mjOBJ_BODY, model.geom_bodyid[other]);
      return fmt::format("{} '{}' stands in {} '{}', {:.0f} mm deep", body.empty() ? "link" : "body",
                         !body.empty()     ? body
                         : link != nullptr ? std::string_view{link}
                                           : std::string_view{},
                         obstacle.empty() ? "body" : "obstacle", into, -1e3 * contact.dist);
    }
  }
  return std::nullopt;
}

}  // namespace hirosco::simulation
