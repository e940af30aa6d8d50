// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/on_board_model.hpp"

namespace hirosco::robot_arm {
namespace {

/// N m or N, of what fades.
constexpr double nothing = 1e-9;

}  // namespace

void OnBoardModel::begin(double cycle_s) {
  const robotics::Model& model = parts_.known.model();
  dynamics_.emplace(model, robotics::Base::Fixed);
  observer_.emplace(model.joint_count(), cycle_s, observer_gain_per_s);
  brakes_.setZero(model.joint_count());
  updated_ = false;
}

void OnBoardModel::update() noexcept {
  const UrdfArm& known = parts_.known;
  const Measured& measured = parts_.drives.measured();
  state_.q = measured.position;
  state_.qd = measured.velocity;
  const auto gravity = parts_.parameters.gravity_m_s2.load();
  dynamics_->set_gravity({gravity[0], gravity[1], gravity[2]});
  dynamics_->update(state_);
  const robotics::Pose tip = dynamics_->frame_pose(known.tip());
  parts_.parameters.tool.store(values_of(tip * pose_of(parts_.parameters.tool_place.load())));
  robotics::Coordinates of_payload = robotics::Coordinates::Zero(known.model().joint_count());
  Law::add_payload(payload(), known.tip(), {gravity[0], gravity[1], gravity[2]}, *dynamics_,
                   JointVector::Zero(known.model().joint_count()), of_payload);
  const SampleTime::Between between = parts_.drives.sample_time().between();
  if (between.s > 0) {
    observer_->update(measured, *dynamics_, of_payload, between);
    brakes_ *= observer_->kept();
  }
  parts_.parameters.external_torque.store(joints_of(observer_->external()));
  if (brakes_.cwiseAbs().maxCoeff() < nothing) brakes_.setZero();
  tell_work();
  updated_ = true;
}

/// With which force something acts on the tool.
void OnBoardModel::tell_work() noexcept {
  lever_.update(*dynamics_, parts_.known.tip(), pose_of(parts_.parameters.tool_place.load()).position);
  parts_.work.tell(lever_.force(observer_->external() - brakes_), lever_.velocity(parts_.drives.measured().velocity));
}

void OnBoardModel::forget_external() noexcept {
  if (observer_) observer_->reset();
  brakes_.setZero();
}

Payload OnBoardModel::payload() const noexcept {
  const auto values = parts_.parameters.payload.load();
  return {values.mass_kg, {values.place_m[0], values.place_m[1], values.place_m[2]}};
}

ForceSensor::Hanging OnBoardModel::hanging() const noexcept {
  const auto gravity = parts_.parameters.gravity_m_s2.load();
  const Payload its = payload();
  const robotics::Matrix3 turned = dynamics_->frame_pose(parts_.known.tip()).rotation;
  return {turned, turned * its.place_m, its.mass_kg * Vector3{gravity[0], gravity[1], gravity[2]}};
}

JointVector OnBoardModel::held(const Payload& payload) noexcept {
  const auto gravity = parts_.parameters.gravity_m_s2.load();
  robotics::Coordinates held;
  dynamics_->bias(held);
  Law::add_payload(payload, parts_.known.tip(), {gravity[0], gravity[1], gravity[2]}, *dynamics_,
                   JointVector::Zero(held.size()), held);
  return held;
}

}  // namespace hirosco::robot_arm
