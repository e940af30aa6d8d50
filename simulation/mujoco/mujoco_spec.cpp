// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_spec.hpp"

#include <algorithm>
#include <utility>

#include "simulation/mujoco/geoms.hpp"
#include "simulation/mujoco/mujoco_files.hpp"

namespace hirosco::simulation {
namespace {

/// Where bodies are held by friction alone: without these what is held creeps by tenths of a millimetre a second.
constexpr int no_slip_iterations = 10;
constexpr const char* obstacle_mark = "obstacle ";
constexpr const char* loose_mark = "loose ";

mjsGeom& add_other(const Shape& shape, double friction, int priority, mjsBody& body, const std::string& name) {
  mjsGeom& geom = add_geom(shape, friction, priority, body, name);
  geom.contype = of_links | of_others;
  geom.conaffinity = of_links | of_meshes;
  return geom;
}

/// Its friction goes before that of whatever it touches.
void add_loose(const LooseBody& loose, mjSpec& spec) {
  const Obstacle& standing = loose.standing;
  mjsBody& body = *mjs_addBody(mjs_findBody(&spec, "world"), nullptr);
  std::ranges::copy(standing.shape.place_m, body.pos);
  mju_euler2Quat(body.quat, standing.shape.turned_rad.data(), "XYZ");
  mjs_addFreeJoint(&body);
  Shape shape = standing.shape;
  shape.place_m = shape.turned_rad = {};
  mjsGeom& geom = add_other(shape, standing.friction, 2, body, loose_mark + standing.name);
  geom.mass = loose.mass_kg;
}

}  // namespace

std::string body_name(const std::string& link) { return link == "world" ? "world_link" : link; }

std::string error_of(mjSpec& spec) {
  std::string text = mjs_getError(&spec);
  std::ranges::replace(text, '\n', ' ');
  return "MuJoCo: " + text;
}

bool hang_payload(mjSpec& spec, const std::string& carrier, const std::string& name) {
  mjsBody* body = mjs_findBody(&spec, carrier.c_str());
  if (body == nullptr) return false;
  if (mjsBody* before = mjs_findBody(&spec, name.c_str())) mjs_delete(&spec, before->element);
  mjsBody* payload = mjs_addBody(body, nullptr);
  if (payload == nullptr) return false;
  mjs_setName(payload->element, name.c_str());
  payload->explicitinertial = 1;
  return true;
}

MujocoSpec::MujocoSpec(Content content)
    : spec_{std::move(content.spec)},
      joints_{std::move(content.joints)},
      root_{std::move(content.root)},
      further_dofs_{content.further_dofs},
      equalities_{content.equalities},
      pairs_left_out_{content.pairs_left_out},
      octets_{std::move(content.octets)} {
  robots_.front().joints = joints_.size();
  robots_.front().of_scene = content.of_scene;
  robots_.front().left_out = std::move(content.left_out);
}

bool MujocoSpec::hang_payload_on(const std::string& link, std::size_t robot) {
  const auto of_another = [&](const Robot& each) { return !each.prefix.empty() && link.starts_with(each.prefix); };
  if (link == payload_body || std::ranges::any_of(robots_, of_another)) return false;
  const std::string& prefix = robots_[robot].prefix;
  return hang_payload(*spec_, prefix + body_name(link), prefix + payload_body);
}

std::expected<void, std::string> MujocoSpec::let_float() {
  if (floats_) return {};
  if (is_scene()) return std::unexpected{"what floats in a scene its file says"};
  if (robots_.size() > 1) return std::unexpected{"it is to float before other robots are mounted in its world"};
  if (auto done = FloatingBase::add_to(*spec_, root_); !done) return done;
  floats_ = true;
  return {};
}

std::expected<MujocoModel, std::string> MujocoSpec::compile(std::span<const Obstacle> obstacles,
                                                            std::span<const LooseBody> bodies) const {
  const std::unique_ptr<mjSpec, MujocoFree> spec{mj_copySpec(spec_.get())};
  if (spec == nullptr) return std::unexpected{"MuJoCo does not copy the robot"};
  // Each is a body of its own: the base is no neighbour of what stands around it.
  for (const Obstacle& obstacle : obstacles)
    add_other(obstacle.shape, obstacle.friction, 1, *mjs_addBody(mjs_findBody(spec.get(), "world"), nullptr),
              obstacle_mark + obstacle.name);
  for (const LooseBody& body : bodies) add_loose(body, *spec);
  if (!bodies.empty()) spec->option.noslip_iterations = no_slip_iterations;
  MujocoModel model{mj_compile(spec.get(), MujocoFiles{octets_}.get())};
  if (model == nullptr) return std::unexpected{error_of(*spec)};
  if (static_cast<std::size_t>(model->neq) != equalities_ ||
      static_cast<std::size_t>(model->nexclude) != pairs_left_out_)
    return std::unexpected{"MuJoCo lost some of the robot"};
  return model;
}

namespace {

[[nodiscard]] std::string_view marked(const mjModel& model, int geom, std::string_view mark) noexcept {
  const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
  const std::string_view text = name != nullptr ? name : "";
  return text.starts_with(mark) ? text.substr(mark.size()) : std::string_view{};
}

}  // namespace

std::string_view MujocoSpec::obstacle_of(const mjModel& model, int geom) noexcept {
  return marked(model, geom, obstacle_mark);
}

std::string_view MujocoSpec::loose_body_of(const mjModel& model, int geom) noexcept {
  return marked(model, geom, loose_mark);
}

}  // namespace hirosco::simulation
