// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/floating_base.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

/// A thin disc: about its axis, and half of it across. At its full momentum it turns at 6000 revolutions per minute.
constexpr double wheel_kg_m2 = 0.0127;
constexpr double wheel_kg = 1;

[[nodiscard]] std::string wheel_name(int wheel) { return fmt::format("hirosco_wheel_{}", "xyz"[wheel]); }

}  // namespace

std::expected<void, std::string> FloatingBase::add_to(mjSpec& spec, const std::string& root) {
  mjsBody* base = mjs_findBody(&spec, root.c_str());
  if (base == nullptr) return std::unexpected{"MuJoCo has no link '" + root + "'"};
  if (!(base->mass > wheels * wheel_kg))
    return std::unexpected{fmt::format("a base that floats has more than {} kg, and link '{}' has {:g}",
                                       wheels * wheel_kg, root, base->mass)};
  mjs_addFreeJoint(base);
  for (int i = 0; i < wheels; ++i) {
    mjsBody* wheel = mjs_addBody(base, nullptr);
    mjs_setName(wheel->element, wheel_name(i).c_str());
    std::ranges::copy_n(base->ipos, 3, wheel->pos);
    wheel->mass = wheel_kg;
    std::ranges::fill_n(wheel->inertia, 3, wheel_kg_m2 / 2);
    wheel->inertia[i] = wheel_kg_m2;
    wheel->explicitinertial = 1;
    mjsJoint* axle = mjs_addJoint(wheel, nullptr);
    mjs_setName(axle->element, wheel_name(i).c_str());
    axle->type = mjJNT_HINGE;
    std::ranges::fill_n(axle->axis, 3, 0.0);
    axle->axis[i] = 1;
  }
  return {};
}

void FloatingBase::find(mjModel& model, const std::string& root) noexcept {
  body_ = std::max(0, mj_name2id(&model, mjOBJ_BODY, root.c_str()));
  const int joint = model.body_jntadr[body_];
  position_ = model.jnt_qposadr[joint];
  dof_ = model.jnt_dofadr[joint];
  for (int i = 0; i < wheels; ++i)
    wheel_dof_[static_cast<std::size_t>(i)] = model.jnt_dofadr[mj_name2id(&model, mjOBJ_JOINT, wheel_name(i).c_str())];
  model.body_mass[body_] -= wheels * wheel_kg;
  // Across their axes the wheels turn with the base: each axis has two halves of a wheel.
  for (int axis = 0; axis < 3; ++axis) model.body_inertia[3 * body_ + axis] -= wheel_kg_m2;
}

FloatingBase::Vector FloatingBase::position_m(const mjData& data) const noexcept {
  Vector found;
  std::copy_n(data.qpos + position_, 3, found.begin());
  return found;
}
FloatingBase::Quaternion FloatingBase::orientation(const mjData& data) const noexcept {
  Quaternion found;
  std::copy_n(data.qpos + position_ + 3, 4, found.begin());
  return found;
}
FloatingBase::Vector FloatingBase::rate_rad_s(const mjData& data) const noexcept {
  Vector found;
  std::copy_n(data.qvel + dof_ + 3, 3, found.begin());
  return found;
}
FloatingBase::Vector FloatingBase::velocity_m_s(const mjData& data) const noexcept {
  Vector found;
  std::copy_n(data.qvel + dof_, 3, found.begin());
  return found;
}
/// The base's own rotation counts: a wheel that nobody drives keeps what it has.
FloatingBase::Vector FloatingBase::wheels_n_m_s(const mjData& data) const noexcept {
  Vector found = rate_rad_s(data);
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = wheel_kg_m2 * (found[i] + data.qvel[wheel_dof_[i]]);
  return found;
}

FloatingBase::Momentum FloatingBase::momentum(const mjModel& model, mjData& data) const noexcept {
  mj_subtreeVel(&model, &data);
  Momentum found;
  std::copy_n(data.subtree_angmom + 3 * body_, 3, found.angular_n_m_s.begin());
  for (std::size_t i = 0; i < 3; ++i)
    found.linear_n_s[i] = model.body_subtreemass[body_] * data.subtree_linvel[3 * static_cast<std::size_t>(body_) + i];
  return found;
}

void FloatingBase::set_twist(mjData& data, const std::array<double, 6>& twist) const noexcept {
  std::copy_n(twist.begin(), 3, data.qvel + dof_ + 3);
  mju_rotVecQuat(data.qvel + dof_, twist.data() + 3, data.qpos + position_ + 3);
}
void FloatingBase::set_wheels(mjData& data, const Vector& momentum_n_m_s) noexcept {
  const Vector rate = rate_rad_s(data);
  for (std::size_t i = 0; i < rate.size(); ++i) data.qvel[wheel_dof_[i]] = momentum_n_m_s[i] / wheel_kg_m2 - rate[i];
}

void FloatingBase::drive(const Vector& by_wheels, const Vector& by_thrusters) noexcept {
  for (std::size_t i = 0; i < by_wheels.size(); ++i) {
    by_wheels_[i] = std::clamp(by_wheels[i], -wheel_torque_n_m, wheel_torque_n_m);
    by_thrusters_[i] = std::clamp(by_thrusters[i], -thruster_torque_n_m, thruster_torque_n_m);
  }
}

void FloatingBase::apply(mjData& data) const noexcept {
  const Vector stored = wheels_n_m_s(data);
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const bool full = std::abs(stored[i]) >= wheel_momentum_n_m_s && stored[i] * by_wheels_[i] < 0;
    data.qfrc_applied[wheel_dof_[i]] = full ? 0 : -by_wheels_[i];
  }
  mju_rotVecQuat(data.xfrc_applied + 6 * body_ + 3, by_thrusters_.data(), data.qpos + position_ + 3);
}

}  // namespace hirosco::simulation
