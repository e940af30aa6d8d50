// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_robot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

constexpr double brake_share = 2;  ///< of a joint's effort
constexpr double slowing_share = 0.3;
/// Dry friction of MuJoCo gives way a little; this little: how near to rigid.
constexpr double friction_rigid = 0.9999;
/// Of the robot's mass: nothing that touches resists more.
constexpr double heaviest_share = 10;
/// Deeper than what presses can come: it was put into what is there already.
constexpr double within_m = 0.005;

}  // namespace

std::expected<MujocoRobot, std::string> MujocoRobot::make(std::string_view urdf, const MeshSource& meshes) {
  auto spec = MujocoSpec::make(urdf, meshes);
  if (!spec) return std::unexpected{std::move(spec.error())};
  return made_of(std::move(*spec));
}

std::expected<MujocoRobot, std::string> MujocoRobot::make_in_scene(std::string_view mjcf, std::string_view urdf,
                                                                   const MeshSource& files) {
  auto joints = MujocoSpec::driven_joints(urdf);
  if (!joints) return std::unexpected{std::move(joints.error())};
  auto spec = MujocoSpec::make_scene(mjcf, std::move(*joints), files);
  if (!spec) return std::unexpected{std::move(spec.error())};
  return made_of(std::move(*spec));
}

std::expected<MujocoRobot, std::string> MujocoRobot::made_of(MujocoSpec spec) {
  MujocoRobot robot{std::move(spec)};
  if (robot.spec_.is_scene()) robot.softness_s_.reset();
  for (const DrivenJoint& joint : robot.spec_.joints())
    robot.joints_.push_back({.name = joint.name, .effort = joint.effort});
  if (auto built = robot.build({}, {}); !built) return std::unexpected{std::move(built.error())};
  return robot;
}

/// The robot is at rest where its file has it at zero.
std::expected<void, std::string> MujocoRobot::build(std::span<const Obstacle> obstacles,
                                                    std::span<const LooseBody> bodies) {
  auto compiled = spec_.compile(obstacles, bodies);
  if (!compiled) return std::unexpected{std::move(compiled.error())};
  mjModel& model = **compiled;
  MujocoData data{mj_makeData(&model)};
  if (data == nullptr) return std::unexpected{"MuJoCo has no memory for it"};
  const std::size_t of_base = spec_.floats() ? FloatingBase::dofs : 0;
  if (static_cast<std::size_t>(model.nv) != joints_.size() + spec_.further_dofs() + of_base + 6 * bodies.size())
    return std::unexpected{"MuJoCo has another number of joints than the file"};
  for (Joint& joint : joints_) {
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
    if (id < 0) return std::unexpected{"MuJoCo has no joint '" + joint.name + "'"};
    joint.position = model.jnt_qposadr[id];
    joint.dof = model.jnt_dofadr[id];
    joint.friction = model.dof_frictionloss[joint.dof];
    joint.damping = model.dof_damping[joint.dof];
    if (joint.rotor) model.dof_armature[joint.dof] = *joint.rotor;
    model.dof_solref[mjNREF * joint.dof] = MujocoSpec::friction_s;
    model.dof_solimp[mjNIMP * joint.dof] = model.dof_solimp[mjNIMP * joint.dof + 1] = friction_rigid;
    if (!spec_.is_scene()) model.jnt_solref[mjNREF * id] = MujocoSpec::end_s;
  }
  if (model_ != nullptr) std::ranges::copy_n(model_->opt.gravity, 3, model.opt.gravity);
  for (int geom = 0; softness_s_ && geom < model.ngeom; ++geom) model.geom_solref[mjNREF * geom] = *softness_s_;
  if (spec_.floats()) base_.find(model, spec_.root());
  model_ = std::move(*compiled);
  data_ = std::move(data);
  tip_ = std::max(0, mj_name2id(model_.get(), mjOBJ_BODY, MujocoSpec::payload_body));
  bodies_.assign(bodies.begin(), bodies.end());
  pulled_n_.resize(bodies_.size());
  find_its_bodies();
  mass_.assign(model_->body_mass, model_->body_mass + first_body());
  inertia_.assign(model_->body_inertia, model_->body_inertia + 3 * first_body());
  for (Joint& joint : joints_) joint.brakes = Brakes::Closed;
  brake();
  change_inertia();
  return {};
}

void MujocoRobot::find_its_bodies() {
  of_robot_.assign(static_cast<std::size_t>(model_->nbody), false);
  for (int body = 1; body < first_body(); ++body) {
    const auto moves_it = [&](const Joint& joint) { return model_->dof_bodyid[joint.dof] == body; };
    of_robot_[static_cast<std::size_t>(body)] =
        !spec_.is_scene() || is_of_robot(model_->body_parentid[body]) || std::ranges::any_of(joints_, moves_it);
  }
}

/// What moves goes on where it is, as fast as it is.
std::expected<void, std::string> MujocoRobot::surround(std::vector<Obstacle> obstacles, std::vector<LooseBody> bodies,
                                                       std::string_view moved) {
  const std::vector<LooseBody> bodies_before = bodies_;
  const std::vector<std::array<double, 3>> pulled_before = pulled_n_;
  const Standing before = standing();
  Standing after = before;
  std::erase_if(after.bodies, [&](const Standing::Body& body) { return body.name == moved; });
  std::vector<std::array<double, 3>> pulled(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto& name = bodies[i].standing.name;
    const auto known = std::ranges::find(bodies_before, name, [](const LooseBody& body) { return body.standing.name; });
    if (known != bodies_before.end() && name != moved)
      pulled[i] = pulled_before[static_cast<std::size_t>(known - bodies_before.begin())];
  }
  if (auto built = build(obstacles, bodies); !built) return built;
  pulled_n_ = std::move(pulled);
  stand(after);
  if (auto within = overlap()) {
    // What was there before could be made.
    if (auto built = build(obstacles_, bodies_before); !built) return built;
    pulled_n_ = pulled_before;
    stand(before);
    return std::unexpected{*within + ", where the robot is now"};
  }
  obstacles_ = std::move(obstacles);
  return {};
}

std::expected<void, std::string> MujocoRobot::put(const Obstacle& obstacle) {
  std::vector<Obstacle> all = obstacles_;
  const auto found = std::ranges::find(all, obstacle.name, &Obstacle::name);
  if (found != all.end()) *found = obstacle;
  else if (all.size() == most_obstacles) return std::unexpected{fmt::format("there are {} obstacles", most_obstacles)};
  else all.push_back(obstacle);
  return surround(std::move(all), bodies_);
}

std::expected<void, std::string> MujocoRobot::take_away(std::string_view name) {
  std::vector<Obstacle> all = obstacles_;
  if (std::erase_if(all, [&](const Obstacle& each) { return each.name == name; }) == 0)
    return std::unexpected{fmt::format("there is no obstacle '{}'", name)};
  return surround(std::move(all), bodies_);
}

/// What moves and is in what stands or lies around it; in words.
std::optional<std::string> MujocoRobot::overlap() const {
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (contact.dist > -within_m) continue;
    for (const auto& [geom, other] :
         {std::pair{contact.geom[0], contact.geom[1]}, {contact.geom[1], contact.geom[0]}}) {
      const std::string_view obstacle = MujocoSpec::obstacle_of(*model_, geom);
      const std::string_view into = obstacle.empty() ? MujocoSpec::loose_body_of(*model_, geom) : obstacle;
      const std::string_view body = MujocoSpec::loose_body_of(*model_, other);
      if (into.empty()) continue;
      const char* link = mj_id2name(model_.get(), mjOBJ_BODY, model_->geom_bodyid[other]);
      return fmt::format("{} '{}' stands in {} '{}', {:.0f} mm deep", body.empty() ? "link" : "body",
                         !body.empty()     ? body
                         : link != nullptr ? std::string_view{link}
                                           : std::string_view{},
                         obstacle.empty() ? "body" : "obstacle", into, -1e3 * contact.dist);
    }
  }
  return std::nullopt;
}

double MujocoRobot::position(std::size_t joint) const noexcept { return data_->qpos[joints_[joint].position]; }
double MujocoRobot::velocity(std::size_t joint) const noexcept { return data_->qvel[joints_[joint].dof]; }
std::span<const double, 3> MujocoRobot::tip_m() const noexcept {
  return std::span<const double, 3>{data_->xpos + 3 * tip_, 3};
}

std::span<const double, 4> MujocoRobot::tip_orientation() const noexcept {
  return std::span<const double, 4>{data_->xquat + 4 * tip_, 4};
}

std::expected<void, std::string> MujocoRobot::let_float() {
  if (auto done = spec_.let_float(); !done) return done;
  const std::vector<LooseBody> bodies = bodies_;
  return build(obstacles_, bodies);
}

std::expected<void, std::string> MujocoRobot::set_tip(const std::string& link) {
  if (!spec_.hang_payload_on(link)) return std::unexpected{fmt::format("there is no link '{}'", link)};
  const Standing before = standing();
  const std::vector<LooseBody> bodies = bodies_;
  if (auto built = build(obstacles_, bodies); !built) return built;
  stand(before);
  feel();
  return {};
}

void MujocoRobot::set_in_motion(const std::array<double, 6>& base_twist, std::span<const double> velocities) noexcept {
  if (base_.floats()) base_.set_twist(*data_, base_twist);
  for (std::size_t i = 0; i < std::min(velocities.size(), joints_.size()); ++i)
    data_->qvel[joints_[i].dof] = velocities[i];
  if (base_.floats()) base_.set_wheels(*data_, {});
  mj_forward(model_.get(), data_.get());
}

double MujocoRobot::kinetic_energy_j() const {
  std::vector<double> momentum(static_cast<std::size_t>(model_->nv));
  mj_mulM(model_.get(), data_.get(), momentum.data(), data_->qvel);
  return mju_dot(momentum.data(), data_->qvel, static_cast<int>(model_->nv)) / 2;
}

std::expected<void, std::string> MujocoRobot::place(std::span<const double> positions) {
  const Standing before = standing();
  mj_resetData(model_.get(), data_.get());
  if (!bodies_.empty()) {
    Standing kept = standing();
    kept.bodies = before.bodies;
    stand(kept);
  }
  for (std::size_t i = 0; i < std::min(positions.size(), joints_.size()); ++i)
    data_->qpos[joints_[i].position] = positions[i];
  follow();
  mj_forward(model_.get(), data_.get());
  auto within = overlap();
  if (within) stand(before);
  feel();
  if (within) return std::unexpected{std::move(*within)};
  return {};
}

/// What mimics a joint stands where it follows it to.
void MujocoRobot::follow() noexcept {
  for (int i = 0; i < model_->neq; ++i) {
    if (model_->eq_type[i] != mjEQ_JOINT || model_->eq_obj2id[i] < 0) continue;
    const mjtNum* numbers = model_->eq_data + mjNEQDATA * i;
    data_->qpos[model_->jnt_qposadr[model_->eq_obj1id[i]]] =
        numbers[0] + numbers[1] * data_->qpos[model_->jnt_qposadr[model_->eq_obj2id[i]]];
  }
}

void MujocoRobot::brake() noexcept {
  for (const Joint& joint : joints_) {
    const double held = joint.brakes == Brakes::Open ? 0
                        : joint.brakes == Brakes::Slowing
                            ? std::abs(data_->qfrc_bias[joint.dof]) + slowing_share * joint.effort
                            : brake_share * joint.effort;
    model_->dof_frictionloss[joint.dof] = joint.friction * friction_factor_ + more_friction_ + held;
    model_->dof_damping[joint.dof] = joint.damping * friction_factor_;
  }
}

void MujocoRobot::drive(std::size_t joint, double torque, Brakes brakes) noexcept {
  Joint& its = joints_[joint];
  its.brakes = brakes;
  data_->qfrc_applied[its.dof] = std::clamp(torque, -its.effort, its.effort);
}

std::optional<std::size_t> MujocoRobot::joint(std::string_view name) const noexcept {
  const auto found =
      std::ranges::find(joints_, name, [](const Joint& joint) -> std::string_view { return joint.name; });
  if (found == joints_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - joints_.begin());
}

void MujocoRobot::step(std::span<const double> torques, Brakes brakes, Duration span) noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) drive(i, i < torques.size() ? torques[i] : 0, brakes);
  step(span);
}

void MujocoRobot::step(Duration span) noexcept {
  brake();
  if (base_.floats()) base_.apply(*data_);
  const auto steps =
      std::max<std::int64_t>(1, std::llround(std::ceil(seconds(span) / MujocoSpec::longest_sub_step_s - 1e-9)));
  model_->opt.timestep = seconds(span) / static_cast<double>(steps);
  for (std::int64_t i = 0; i < steps; ++i) mj_step(model_.get(), data_.get());
  // Once more, for the sensors: what stands there is of a stage within the last sub-step.
  mj_forward(model_.get(), data_.get());
  feel();
}

/// Friction and brakes act between drive and link, mechanical stops and what touches on the link itself.
void MujocoRobot::feel() noexcept {
  for (Joint& joint : joints_)
    joint.torque = data_->qfrc_applied[joint.dof] + data_->qfrc_passive[joint.dof] -
                   model_->dof_armature[joint.dof] * data_->qacc[joint.dof];
  for (int i = 0; i < data_->nefc; ++i) {
    if (data_->efc_type[i] != mjCNSTR_FRICTION_DOF) continue;
    const auto found = std::ranges::find(joints_, data_->efc_id[i], &Joint::dof);
    if (found != joints_.end()) found->torque += data_->efc_force[i];
  }
  touched_ = {};
  const auto of_robot = [&](int geom) {
    return is_of_robot(model_->geom_bodyid[geom]) && model_->body_weldid[model_->geom_bodyid[geom]] != 0;
  };
  const bool others_touch = spec_.is_scene() || !bodies_.empty();
  for (int i = 0; i < data_->ncon; ++i) {
    if (data_->contact[i].efc_address < 0) continue;
    if (others_touch && !of_robot(data_->contact[i].geom[0]) && !of_robot(data_->contact[i].geom[1])) continue;
    std::array<mjtNum, 6> wrench{};
    mj_contactForce(model_.get(), data_.get(), i, wrench.data());
    ++touched_.contacts;
    touched_.normal_n += wrench[0];
  }
}

void MujocoRobot::change_inertia() noexcept {
  for (int body = 0; body < first_body(); ++body) {
    const auto i = static_cast<std::size_t>(body);
    if (!is_of_robot(body)) continue;
    model_->body_mass[body] = mass_[i] * mass_factor_;
    for (std::size_t axis = 0; axis < 3; ++axis)
      model_->body_inertia[3 * i + axis] = inertia_[3 * i + axis] * inertia_factor_;
  }
  if (tip_ > 0) model_->body_mass[tip_] = payload_kg_;
  // It leaves the robot where its file has it at zero.
  const std::vector<double> where(data_->qpos, data_->qpos + model_->nq),
      how_fast(data_->qvel, data_->qvel + model_->nv);
  mj_setConst(model_.get(), data_.get());
  // How softly a contact gives way MuJoCo reckons from what a link's centre resists in the first posture: of a link that turns about its
  // own centre that is beyond all bounds, and so would be its contacts.
  const double heaviest_kg = heaviest_share * std::accumulate(mass_.begin(), mass_.end(), 0.0) * mass_factor_;
  for (int body = 0; body < first_body(); ++body)
    if (is_of_robot(body) && model_->body_weldid[body] != 0 && heaviest_kg > 0)
      model_->body_invweight0[2 * body] = std::max(model_->body_invweight0[2 * body], 1 / heaviest_kg);
  std::ranges::copy(where, data_->qpos);
  std::ranges::copy(how_fast, data_->qvel);
  mj_forward(model_.get(), data_.get());
}

void MujocoRobot::set_mass_factor(double factor) noexcept {
  mass_factor_ = factor;
  change_inertia();
}
void MujocoRobot::set_inertia_factor(double factor) noexcept {
  inertia_factor_ = factor;
  change_inertia();
}
void MujocoRobot::set_payload(double mass_kg) noexcept {
  payload_kg_ = mass_kg;
  change_inertia();
}
void MujocoRobot::set_friction(double factor, double more) noexcept {
  friction_factor_ = factor;
  more_friction_ = more;
}
void MujocoRobot::set_rotors(std::span<const double> inertias) noexcept {
  for (std::size_t i = 0; i < std::min(inertias.size(), joints_.size()); ++i)
    model_->dof_armature[joints_[i].dof] = *(joints_[i].rotor = inertias[i]);
  change_inertia();
}
void MujocoRobot::set_gravity(double x, double y, double z) noexcept {
  model_->opt.gravity[0] = x;
  model_->opt.gravity[1] = y;
  model_->opt.gravity[2] = z;
}
void MujocoRobot::set_softness(double time_constant_s) noexcept {
  softness_s_ = time_constant_s;
  for (int geom = 0; geom < model_->ngeom; ++geom) model_->geom_solref[mjNREF * geom] = time_constant_s;
}
void MujocoRobot::push(double x, double y, double z) noexcept {
  mjtNum* force = data_->xfrc_applied + 6 * tip_;
  force[0] = x;
  force[1] = y;
  force[2] = z;
}

}  // namespace hirosco::simulation
