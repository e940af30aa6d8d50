// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_robot.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "hirosco/xml/reader.hpp"

namespace hirosco::simulation {
namespace {

using xml::Element;

constexpr double longest_sub_step_s = 0.0005;
constexpr double brake_share = 2;  ///< of a joint's effort
constexpr double slowing_share = 0.3;
/// Of a joint whose file says nothing.
constexpr double default_effort = 100;
/// Dry friction of MuJoCo gives way a little; this little: time constant and how near to rigid.
constexpr double friction_s = 0.001;
constexpr double friction_rigid = 0.9999;

/// What MuJoCo is given of a file: what moves and has mass. Shapes would want files of their own.
constexpr std::array known{"robot", "link",   "inertial", "origin", "mass",  "inertia",
                           "joint", "parent", "child",    "axis",   "limit", "dynamics"};

void write(const Element& element, std::string& text) {
  if (std::ranges::find(known, element.name) == known.end()) return;
  text += "<" + element.name;
  for (const auto& [name, value, at, value_at] : element.attributes) {
    if (name.find(':') != std::string::npos || value.find('"') != std::string::npos) continue;
    // A link of this name would be MuJoCo's own world.
    text += " " + name + "=\"" + (value == "world" ? "world_link" : value) + "\"";
  }
  text += ">";
  if (element.name == "robot")
    text += R"(<mujoco><compiler fusestatic="false" balanceinertia="false" boundmass="0" boundinertia="0"/></mujoco>)";
  for (const Element& child : element.children) write(child, text);
  text += "</" + element.name + ">";
}

[[nodiscard]] std::string attribute(const Element& element, std::string_view name) {
  const auto* found = element.find(name);
  return found != nullptr ? found->value : std::string{};
}

[[nodiscard]] const Element* child(const Element& element, std::string_view name) {
  const auto found = std::ranges::find(element.children, name, &Element::name);
  return found != element.children.end() ? &*found : nullptr;
}

[[nodiscard]] double number(const Element& element, std::string_view name, double otherwise) {
  const std::string text = attribute(element, name);
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc{} && std::isfinite(value) ? value : otherwise;
}

[[nodiscard]] double effort_of(const Element& joint) {
  const Element* limit = child(joint, "limit");
  const double effort = limit != nullptr ? number(*limit, "effort", 0) : 0;
  return effort > 0 ? effort : default_effort;
}

/// Who follows whom. It has no drive and no brake of its own.
struct Mimic {
  std::string joint;
  std::string followed;
  double multiplier{1};
  double offset{0};
};

/// As a constraint: MuJoCo knows such joints in no URDF file.
void add(const Mimic& mimic, mjSpec& spec) {
  mjsEquality& equal = *mjs_addEquality(&spec, nullptr);
  equal.type = mjEQ_JOINT;
  equal.objtype = mjOBJ_JOINT;
  mjs_setString(equal.name1, mimic.joint.c_str());
  mjs_setString(equal.name2, mimic.followed.c_str());
  equal.data[0] = mimic.offset;
  equal.data[1] = mimic.multiplier;
  equal.solref[0] = friction_s;
}

}  // namespace

std::expected<MujocoRobot, std::string> MujocoRobot::make(std::string_view urdf) {
  const auto tree = xml::read_tree(urdf);
  if (!tree) return std::unexpected{"the URDF file: " + tree.error().reason};
  MujocoRobot robot;
  std::vector<std::string> carried, carrying;
  std::vector<Mimic> mimics;
  for (const Element& element : tree->children) {
    if (element.name != "joint") continue;
    if (const Element* parent = child(element, "parent")) carrying.push_back(attribute(*parent, "link"));
    if (const Element* carries = child(element, "child")) carried.push_back(attribute(*carries, "link"));
    const std::string type = attribute(element, "type");
    if (type == "fixed") continue;
    if (const Element* mimic = child(element, "mimic")) {
      mimics.push_back({attribute(element, "name"), attribute(*mimic, "joint"), number(*mimic, "multiplier", 1),
                        number(*mimic, "offset", 0)});
      continue;
    }
    robot.joints_.push_back({.name = attribute(element, "name"), .effort = effort_of(element)});
  }
  const auto leaf = std::ranges::find_if(
      carried, [&](const std::string& link) { return std::ranges::find(carrying, link) == carrying.end(); });
  std::string text;
  write(*tree, text);
  std::array<char, 1000> why{};
  const std::unique_ptr<mjSpec, Free> spec{mj_parseXMLString(text.c_str(), nullptr, why.data(), why.size())};
  if (spec == nullptr) return std::unexpected{std::string{"MuJoCo: "} + why.data()};
  spec->option.integrator = mjINT_RK4;
  spec->option.timestep = longest_sub_step_s;
  spec->option.disableflags |= mjDSBL_CONTACT;
  mjsBody* last = leaf != carried.end() ? mjs_findBody(spec.get(), leaf->c_str()) : nullptr;
  mjsBody* payload = last != nullptr ? mjs_addBody(last, nullptr) : nullptr;
  if (payload != nullptr) {
    mjs_setName(payload->element, "hirosco_payload");
    payload->explicitinertial = 1;
  }
  for (const Mimic& mimic : mimics) add(mimic, *spec);
  robot.model_.reset(mj_compile(spec.get(), nullptr));
  if (robot.model_ == nullptr) return std::unexpected{std::string{"MuJoCo: "} + mjs_getError(spec.get())};
  mjModel& model = *robot.model_;
  robot.data_.reset(mj_makeData(&model));
  if (robot.data_ == nullptr) return std::unexpected{"MuJoCo has no memory for it"};
  for (Joint& joint : robot.joints_) {
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
    if (id < 0) return std::unexpected{"MuJoCo has no joint '" + joint.name + "'"};
    joint.position = model.jnt_qposadr[id];
    joint.dof = model.jnt_dofadr[id];
    joint.friction = model.dof_frictionloss[joint.dof];
    joint.damping = model.dof_damping[joint.dof];
    model.dof_solref[mjNREF * joint.dof] = friction_s;
    model.dof_solimp[mjNIMP * joint.dof] = model.dof_solimp[mjNIMP * joint.dof + 1] = friction_rigid;
  }
  if (static_cast<std::size_t>(model.nv) != robot.joints_.size() + mimics.size())
    return std::unexpected{"MuJoCo has another number of joints than the file"};
  robot.tip_ = std::max(0, mj_name2id(&model, mjOBJ_BODY, "hirosco_payload"));
  robot.mass_.assign(model.body_mass, model.body_mass + model.nbody);
  robot.inertia_.assign(model.body_inertia, model.body_inertia + 3 * model.nbody);
  robot.brake(Brakes::Closed);
  mj_forward(&model, robot.data_.get());
  return robot;
}

double MujocoRobot::position(std::size_t joint) const noexcept { return data_->qpos[joints_[joint].position]; }
double MujocoRobot::velocity(std::size_t joint) const noexcept { return data_->qvel[joints_[joint].dof]; }
std::span<const double, 3> MujocoRobot::tip_m() const noexcept {
  return std::span<const double, 3>{data_->xpos + 3 * tip_, 3};
}

void MujocoRobot::place(std::span<const double> positions) noexcept {
  mj_resetData(model_.get(), data_.get());
  for (std::size_t i = 0; i < std::min(positions.size(), joints_.size()); ++i)
    data_->qpos[joints_[i].position] = positions[i];
  mj_forward(model_.get(), data_.get());
  feel();
}

void MujocoRobot::brake(Brakes brakes) noexcept {
  for (const Joint& joint : joints_) {
    const double held = brakes == Brakes::Open ? 0
                        : brakes == Brakes::Slowing
                            ? std::abs(data_->qfrc_bias[joint.dof]) + slowing_share * joint.effort
                            : brake_share * joint.effort;
    model_->dof_frictionloss[joint.dof] = joint.friction * friction_factor_ + more_friction_ + held;
    model_->dof_damping[joint.dof] = joint.damping * friction_factor_;
  }
}

void MujocoRobot::step(std::span<const double> torques, Brakes brakes, Duration span) noexcept {
  brake(brakes);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double wanted = i < torques.size() ? torques[i] : 0;
    data_->qfrc_applied[joints_[i].dof] = std::clamp(wanted, -joints_[i].effort, joints_[i].effort);
  }
  const auto steps = std::max<std::int64_t>(1, std::llround(std::ceil(seconds(span) / longest_sub_step_s - 1e-9)));
  model_->opt.timestep = seconds(span) / static_cast<double>(steps);
  for (std::int64_t i = 0; i < steps; ++i) mj_step(model_.get(), data_.get());
  // Once more, for the sensors: what stands there is of a stage within the last sub-step.
  mj_forward(model_.get(), data_.get());
  feel();
}

/// Friction and brakes act between drive and link, mechanical stops on the link itself.
void MujocoRobot::feel() noexcept {
  for (Joint& joint : joints_)
    joint.torque = data_->qfrc_applied[joint.dof] + data_->qfrc_passive[joint.dof] -
                   model_->dof_armature[joint.dof] * data_->qacc[joint.dof];
  for (int i = 0; i < data_->nefc; ++i) {
    if (data_->efc_type[i] != mjCNSTR_FRICTION_DOF) continue;
    const auto found = std::ranges::find(joints_, data_->efc_id[i], &Joint::dof);
    if (found != joints_.end()) found->torque += data_->efc_force[i];
  }
}

void MujocoRobot::change_inertia() noexcept {
  for (int body = 0; body < model_->nbody; ++body) {
    const auto i = static_cast<std::size_t>(body);
    model_->body_mass[body] = mass_[i] * mass_factor_;
    for (std::size_t axis = 0; axis < 3; ++axis)
      model_->body_inertia[3 * i + axis] = inertia_[3 * i + axis] * inertia_factor_;
  }
  if (tip_ > 0) model_->body_mass[tip_] = payload_kg_;
  // It leaves the robot where its file has it at zero.
  const std::vector<double> where(data_->qpos, data_->qpos + model_->nq),
      how_fast(data_->qvel, data_->qvel + model_->nv);
  mj_setConst(model_.get(), data_.get());
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
    model_->dof_armature[joints_[i].dof] = inertias[i];
  change_inertia();
}
void MujocoRobot::set_gravity(double x, double y, double z) noexcept {
  model_->opt.gravity[0] = x;
  model_->opt.gravity[1] = y;
  model_->opt.gravity[2] = z;
}
void MujocoRobot::push(double x, double y, double z) noexcept {
  mjtNum* force = data_->xfrc_applied + 6 * tip_;
  force[0] = x;
  force[1] = y;
  force[2] = z;
}

}  // namespace hirosco::simulation
