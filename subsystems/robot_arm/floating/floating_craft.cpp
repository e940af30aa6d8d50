// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_craft.hpp"

namespace hirosco::robot_arm {
namespace {

[[nodiscard]] std::array<double, 3> three_of(const Vector3& v) noexcept { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] std::array<double, 4> four_of(const robotics::Quaternion& q) noexcept {
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

void FloatingCraft::begin(ToolLaw law, double cycle_s) {
  law_ = law;
  cycle_s_ = cycle_s;
  model_.emplace(parts_.known.model(), parts_.known.tip());
  base_.stand_still();
}

void FloatingCraft::carry(const robotics::Pose& tool_in_tip, const Payload& payload) noexcept {
  model_->carry(tool_in_tip, payload);
  find();
}

void FloatingCraft::update() noexcept {
  follow_base();
  find();
}

void FloatingCraft::find() noexcept {
  // A robot with masses always has an inertia; without one the last state stays, and the law's torques are bounded.
  static_cast<void>(model_->update(base(), parts_.drives.measured().position));
  parts_.parameters.tool.store({three_of(tool().position), four_of(robotics::Quaternion{tool().rotation})});
  parts_.parameters.base.store({three_of(base_.position_m()), four_of(base_.orientation())});
  parts_.parameters.conditioning.store(model_->conditioning());
}

/// The base goes on as the joints make it, without momentum, and samples set that right.
void FloatingCraft::follow_base() noexcept {
  if (!tracks()) return base_.stand_still();
  if (!pose_.valid()) base_.forget();
  base_.go_on(model_->base() * parts_.drives.measured().velocity, cycle_s_);
  const BasePose& sample = pose_.value();
  if (!pose_.valid() || pose_.age_cycles() != 0 || sample.quality == 0) return;
  const auto& wxyz = sample.orientation_wxyz;
  base_.take({sample.position_m[0], sample.position_m[1], sample.position_m[2]}, {wxyz[0], wxyz[1], wxyz[2], wxyz[3]});
}

}  // namespace hirosco::robot_arm
