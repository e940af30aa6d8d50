// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/joint_drives.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

constexpr double brake_share = 2;  ///< of a joint's effort
constexpr double slowing_share = 0.3;
/// Dry friction of MuJoCo gives way a little; this little: how near to rigid.
constexpr double friction_rigid = 0.9999;
/// Of a radian of its phase, how far a spring may swing in a sub-step: above it the integrator takes more than some ten-thousandths of it each time.
constexpr double most_of_a_swing = 0.5;

}  // namespace

void JointDrives::add(std::span<const DrivenJoint> joints) {
  for (const DrivenJoint& joint : joints)
    joints_.push_back({.name = joint.name, .effort = joint.effort, .of_scene = joint.of_scene});
}

std::expected<void, std::string> JointDrives::find(mjModel& model) {
  for (Joint& joint : joints_) {
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
    if (id < 0) return std::unexpected{"MuJoCo has no joint '" + joint.name + "'"};
    joint.position = model.jnt_qposadr[id];
    joint.dof = model.jnt_dofadr[id];
    joint.friction = model.dof_frictionloss[joint.dof];
    joint.damping = model.dof_damping[joint.dof];
    joint.spring.reset();
    if (const int spring = mj_name2id(&model, mjOBJ_JOINT, (joint.name + MujocoSpec::spring_mark).c_str()); spring >= 0)
      joint.spring = Spring{model.jnt_qposadr[spring], model.jnt_dofadr[spring], model.jnt_stiffness[spring]};
    if (joint.rotor) model.dof_armature[joint.dof] = *joint.rotor;
    model.dof_solref[mjNREF * joint.dof] = MujocoSpec::friction_s;
    model.dof_solimp[mjNIMP * joint.dof] = model.dof_solimp[mjNIMP * joint.dof + 1] = friction_rigid;
    if (!joint.of_scene) model.jnt_solref[mjNREF * id] = MujocoSpec::end_s;
  }
  return {};
}

std::optional<std::size_t> JointDrives::named(std::string_view name) const noexcept {
  const auto found =
      std::ranges::find(joints_, name, [](const Joint& joint) -> std::string_view { return joint.name; });
  if (found == joints_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - joints_.begin());
}

bool JointDrives::move(int body, const mjModel& model, const MujocoSpec::Robot& robot) const noexcept {
  const std::span its{joints_.data() + robot.first_joint, robot.joints};
  return std::ranges::any_of(its, [&](const Joint& joint) { return model.dof_bodyid[joint.dof] == body; });
}

double JointDrives::position(std::size_t joint, const MujocoWorld& world) const noexcept {
  return world.data().qpos[joints_[joint].position];
}

double JointDrives::velocity(std::size_t joint, const MujocoWorld& world) const noexcept {
  return world.data().qvel[joints_[joint].dof];
}

double JointDrives::given_way(std::size_t joint, const MujocoWorld& world) const noexcept {
  const auto& spring = joints_[joint].spring;
  return spring ? world.data().qpos[spring->position] : 0;
}

std::expected<std::vector<MujocoSpec::Spring>, std::string> JointDrives::springs(std::span<const double> stiffness,
                                                                                 std::span<const double> damping,
                                                                                 const MujocoSpec::Robot& robot,
                                                                                 const MujocoWorld& world) const {
  std::vector<MujocoSpec::Spring> springs;
  for (std::size_t i = 0; i < std::min(stiffness.size(), robot.joints); ++i) {
    const std::size_t joint = robot.first_joint + i;
    if (position(joint, world) != 0)
      return std::unexpected{"its joints are to give way before it is put into a posture"};
    springs.push_back({.stiffness = stiffness[i],
                       .damping = i < damping.size() ? damping[i] : 0,
                       .rotor = world.model().dof_armature[joints_[joint].dof]});
  }
  return springs;
}

std::optional<std::string> JointDrives::too_fast(const MujocoSpec::Robot& robot, const MujocoWorld& world) const {
  const Joint* fastest = nullptr;
  double fastest_rad_s = 0;
  for (const Joint& joint : std::span{joints_.data() + robot.first_joint, robot.joints}) {
    if (!joint.spring) continue;
    // What resists it on both sides.
    const double rad_s = std::sqrt(joint.spring->stiffness * world.model().dof_invweight0[joint.spring->dof]);
    if (fastest != nullptr && !(rad_s > fastest_rad_s)) continue;
    fastest = &joint;
    fastest_rad_s = rad_s;
  }
  if (fastest == nullptr || fastest_rad_s * MujocoSpec::longest_sub_step_s <= most_of_a_swing) return std::nullopt;
  return fmt::format("the spring at joint '{}' would swing with {:.0f} rad/s, and steps of {:g} ms tell apart {:.0f}",
                     fastest->name, fastest_rad_s, 1e3 * MujocoSpec::longest_sub_step_s,
                     most_of_a_swing / MujocoSpec::longest_sub_step_s);
}

void JointDrives::settle(const MujocoSpec::Robot& robot, MujocoWorld& world) const noexcept {
  const std::span its{joints_.data() + robot.first_joint, robot.joints};
  if (std::ranges::none_of(its, [](const Joint& joint) { return joint.spring.has_value(); })) return;
  // Each gives way a little to what the others leave it.
  constexpr int rounds = 5;
  for (int i = 0; i < rounds; ++i) {
    world.forward();
    for (const Joint& joint : its)
      if (joint.spring)
        world.data().qpos[joint.spring->position] =
            -world.data().qfrc_bias[joint.spring->dof] / joint.spring->stiffness;
  }
}

void JointDrives::place(std::span<const double> positions, std::size_t first, MujocoWorld& world) const noexcept {
  for (std::size_t i = 0; i < positions.size() && first + i < joints_.size(); ++i)
    world.data().qpos[joints_[first + i].position] = positions[i];
}

void JointDrives::set_in_motion(std::span<const double> velocities, MujocoWorld& world) const noexcept {
  for (std::size_t i = 0; i < std::min(velocities.size(), joints_.size()); ++i)
    world.data().qvel[joints_[i].dof] = velocities[i];
}

void JointDrives::drive(std::size_t joint, double torque, Brakes brakes, MujocoWorld& world) noexcept {
  Joint& its = joints_[joint];
  its.brakes = brakes;
  world.data().qfrc_applied[its.dof] = std::clamp(torque, -its.effort, its.effort);
}

void JointDrives::close_brakes(MujocoWorld& world) noexcept {
  for (Joint& joint : joints_) joint.brakes = Brakes::Closed;
  brake(world);
}

void JointDrives::brake(MujocoWorld& world) const noexcept {
  for (const Joint& joint : joints_) {
    const double held = joint.brakes == Brakes::Open ? 0
                        : joint.brakes == Brakes::Slowing
                            ? std::abs(world.data().qfrc_bias[joint.dof]) + slowing_share * joint.effort
                            : brake_share * joint.effort;
    world.model().dof_frictionloss[joint.dof] = joint.friction * joint.friction_factor + joint.more_friction + held;
    world.model().dof_damping[joint.dof] = joint.damping * joint.friction_factor;
  }
}

/// Friction and brakes act between drive and link, mechanical stops and what touches on the link itself.
void JointDrives::feel(const MujocoWorld& world) noexcept {
  const mjData& data = world.data();
  for (Joint& joint : joints_)
    joint.torque = data.qfrc_applied[joint.dof] + data.qfrc_passive[joint.dof] -
                   world.model().dof_armature[joint.dof] * data.qacc[joint.dof];
  for (int i = 0; i < data.nefc; ++i) {
    if (data.efc_type[i] != mjCNSTR_FRICTION_DOF) continue;
    const auto found = std::ranges::find(joints_, data.efc_id[i], &Joint::dof);
    if (found != joints_.end()) found->torque += data.efc_force[i];
  }
}

void JointDrives::set_friction(double factor, double more, const MujocoSpec::Robot& robot) noexcept {
  for (Joint& joint : std::span{joints_.data() + robot.first_joint, robot.joints}) {
    joint.friction_factor = factor;
    joint.more_friction = more;
  }
}

void JointDrives::set_rotors(std::span<const double> inertias, std::size_t first, MujocoWorld& world) noexcept {
  for (std::size_t i = 0; i < inertias.size() && first + i < joints_.size(); ++i) {
    Joint& joint = joints_[first + i];
    world.model().dof_armature[joint.dof] = *(joint.rotor = inertias[i]);
  }
}

}  // namespace hirosco::simulation
