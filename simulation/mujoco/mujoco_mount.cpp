// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "simulation/mujoco/geoms.hpp"
#include "simulation/mujoco/mujoco_files.hpp"
#include "simulation/mujoco/mujoco_spec.hpp"

/// A further robot in a world: of another file, under a name of its own, at a place of the mission's (docs/adr/0182).
namespace hirosco::simulation {
namespace {

/// Bits by which robots meet each other, one for each, beyond those by which a file or geoms.hpp says what of one robot meets what.
constexpr int first_robot_bit = 16;
static_assert(first_robot_bit + most_robots < 31 && (of_pieces << most_robots) < 1 << first_robot_bit);
[[nodiscard]] int bit_of(std::size_t robot) { return 1 << (first_robot_bit + static_cast<int>(robot)); }

/// All that touches at all of this robot meets all of those before it; what it does with itself stays. A hull that is larger than its link is no
/// matter here: another robot is no neighbour, and meets no pieces of it besides. `pieces`: its meshes are cut into such (geoms.hpp).
void let_meet(mjSpec& spec, std::size_t robot, bool pieces) {
  int before = 0;
  for (std::size_t each = 0; each < robot; ++each) before |= bit_of(each);
  for (auto* each = mjs_firstElement(&spec, mjOBJ_GEOM); each != nullptr; each = mjs_nextElement(&spec, each)) {
    mjsGeom& geom = *mjs_asGeom(each);
    if (geom.contype == 0 && geom.conaffinity == 0) continue;
    // Each robot has a bit of its own for them.
    const int own_pieces = of_pieces << static_cast<int>(robot);
    if (pieces && geom.contype == of_pieces) {
      geom.contype = geom.conaffinity = own_pieces;
      continue;
    }
    if (pieces && (geom.conaffinity & of_pieces) != 0) geom.conaffinity += own_pieces - of_pieces;
    geom.contype |= bit_of(robot);
    geom.conaffinity |= before;
  }
}

/// What is taken of it: its one body, which may float then, or else all of its world as one that stands.
[[nodiscard]] mjsElement* taken_of(mjSpec& spec) {
  mjsBody* world = mjs_findBody(&spec, "world");
  mjsElement* body = mjs_firstChild(world, mjOBJ_BODY, 0);
  const bool alone =
      body != nullptr && mjs_nextChild(world, body, 0) == nullptr && mjs_firstChild(world, mjOBJ_GEOM, 0) == nullptr;
  return alone ? body : world->element;
}

[[nodiscard]] bool has_names(mjSpec& spec, std::string_view prefix) {
  for (const mjtObj kind : {mjOBJ_BODY, mjOBJ_JOINT})
    for (auto* each = mjs_firstElement(&spec, kind); each != nullptr; each = mjs_nextElement(&spec, each))
      if (std::string_view{mjs_getString(mjs_getName(each))}.starts_with(prefix)) return true;
  return false;
}

}  // namespace

std::expected<MujocoSpec, std::string> MujocoSpec::copied() const {
  MujocoSpec copy;
  copy.spec_.reset(mj_copySpec(spec_.get()));
  if (copy.spec_ == nullptr) return std::unexpected{"MuJoCo does not copy its world"};
  copy.joints_ = joints_;
  copy.root_ = root_;
  copy.floats_ = floats_;
  copy.further_dofs_ = further_dofs_;
  copy.equalities_ = equalities_;
  copy.pairs_left_out_ = pairs_left_out_;
  copy.octets_ = octets_;
  copy.robots_ = robots_;
  return copy;
}

std::expected<MujocoSpec, std::string> MujocoSpec::with(MujocoSpec robot, const Mount& mount) const {
  if (robots_.size() == most_robots)
    return std::unexpected{fmt::format("there are {} robots in its world", most_robots)};
  const std::string prefix = mount.prefix();
  if (has_names(*spec_, prefix))
    return std::unexpected{fmt::format("something in its world has names with '{}' already", prefix)};
  auto copy = copied();
  if (!copy) return copy;
  MujocoSpec& whole = *copy;
  mjSpec& spec = *whole.spec_;
  if (robots_.size() == 1) let_meet(spec, 0, !is_scene());
  let_meet(*robot.spec_, robots_.size(), !robot.is_scene());
  // The world is solved as its first robot's is: MuJoCo would say in a file of its own that it does not take the other's.
  robot.spec_->option = spec.option;
  robot.spec_->authored = spec.authored;
  mjsFrame* frame = mjs_addFrame(mjs_findBody(&spec, "world"), nullptr);
  std::ranges::copy(mount.place_m, frame->pos);
  mju_euler2Quat(frame->quat, mount.turned_rad.data(), "XYZ");
  if (mjs_attach(frame->element, taken_of(*robot.spec_), prefix.c_str(), "") == nullptr)
    return std::unexpected{error_of(spec)};
  for (const DrivenJoint& joint : robot.joints_) {
    whole.joints_.push_back(joint);
    whole.joints_.back().name = prefix + joint.name;
  }
  whole.further_dofs_ += robot.further_dofs_;
  whole.equalities_ += robot.equalities_;
  whole.pairs_left_out_ += robot.pairs_left_out_;
  whole.octets_.merge(robot.octets_);
  if (!robot.octets_.empty()) return std::unexpected{"files of two robots have the same name in their world"};
  whole.robots_.push_back(std::move(robot.robots_.front()));
  Robot& added = whole.robots_.back();
  added.prefix = prefix;
  added.first_joint = joints_.size();
  // Itself, no copy: a copy drops without a word what leads nowhere.
  if (!MujocoModel{mj_compile(&spec, MujocoFiles{whole.octets_}.get())}) return std::unexpected{error_of(spec)};
  return copy;
}

std::size_t MujocoSpec::robot_of(const mjModel& model, int body) const noexcept {
  for (; body > 0; body = model.body_parentid[body]) {
    const char* found = mj_id2name(&model, mjOBJ_BODY, body);
    const std::string_view name = found != nullptr ? found : "";
    for (std::size_t robot = 1; robot < robots_.size(); ++robot)
      if (name.starts_with(robots_[robot].prefix)) return robot;
    if (!name.empty()) break;
  }
  return 0;
}

}  // namespace hirosco::simulation
