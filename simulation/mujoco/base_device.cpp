// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/base_device.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {

BaseDevice::BaseDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings},
      joints_{dynamic_cast<MujocoDevice*>(settings.in_world_of)},
      random_{settings.seed} {}

Result<> BaseDevice::make_world() {
  if (joints_ == nullptr || !joints_->has_world())
    return fail(ErrorCode::Unavailable, "it is in the world of a device of hirosco-sim-mujoco, and there is none");
  if (!joints_->robot().base().floats())
    return fail(ErrorCode::Unavailable, "the base in its world stands: the other device has no setting base free");
  return ok();
}

Result<> BaseDevice::take(OctetReader payload) noexcept {
  for (FloatingBase::Vector* torques : {&by_wheels_, &by_thrusters_})
    for (double& torque : *torques) {
      torque = payload.get<double>();
      if (!std::isfinite(torque)) torque = 0;
    }
  return payload.exhausted() ? ok() : fail(ErrorCode::Malformed, "torque command size");
}

void BaseDevice::advance(Duration) noexcept {
  if (output() == DeviceOutput::Active) joints_->robot().base().drive(by_wheels_, by_thrusters_);
  else joints_->robot().base().drive({}, {});
}

void BaseDevice::write_sensors(OctetWriter& payload) noexcept {
  // Where only what measures is used, that alone is at the one endnode that is left.
  settings().endnode == sensors_endnode ? tell_where(payload) : tell_wheels(payload);
}

void BaseDevice::write_sensors_at(std::string_view endnode, OctetWriter& payload) noexcept {
  if (endnode == sensors_endnode) tell_where(payload);
}

void BaseDevice::tell_wheels(OctetWriter& payload) noexcept {
  for (const double stored : joints_->robot().base().wheels_n_m_s(joints_->robot().data())) payload.put(stored);
}

BaseDevice::Where BaseDevice::measured() noexcept {
  const MujocoRobot& robot = joints_->robot();
  const FloatingBase& base = robot.base();
  const mjData& data = robot.data();
  Where where;
  std::size_t at = 0;
  for (const double place : base.position_m(data))
    where[at++] = place + (position_noise_m_ > 0 ? position_noise_m_ * random_.normal() : 0);
  auto turned = base.orientation(data);
  if (attitude_noise_rad_ > 0) {
    FloatingBase::Vector wrong;
    for (double& each : wrong) each = attitude_noise_rad_ * random_.normal();
    mju_quatIntegrate(turned.data(), wrong.data(), 1);
  }
  for (const double each : turned) where[at++] = each;
  for (const double rate : base.rate_rad_s(data)) where[at++] = rate;
  for (const double velocity : base.velocity_m_s(data)) where[at++] = velocity;
  return where;
}

void BaseDevice::tell_where(OctetWriter& payload) noexcept {
  if (!stuck_ || !told_) told_ = measured();
  for (const double number : *told_) payload.put(number);
}

Result<> BaseDevice::do_fault(const Words& words) {
  constexpr double most_deg = 10, most_m = 1;
  HIROSCO_TRY(words.expect(2));
  if (words[0] == "attitude_noise") {
    HIROSCO_TRY_LET(const double deg, words.number(1, 0, most_deg));
    attitude_noise_rad_ = deg * std::numbers::pi / 180;
    return ok();
  }
  if (words[0] == "position_noise") {
    HIROSCO_TRY_LET(position_noise_m_, words.number(1, 0, most_m));
    return ok();
  }
  if (words[0] == "wheels") {
    const auto numbers = listed_numbers(words[1]);
    if (!numbers || numbers->size() != FloatingBase::wheels) return fail(ErrorCode::InvalidArgument, "three numbers");
    FloatingBase::Vector stored;
    for (std::size_t i = 0; i < stored.size(); ++i) {
      stored[i] = (*numbers)[i];
      if (!(std::abs(stored[i]) <= FloatingBase::wheel_momentum_n_m_s))
        return fail(ErrorCode::OutOfRange, "more than a wheel takes", static_cast<std::int64_t>(i));
    }
    joints_->robot().base().set_wheels(joints_->robot().data(), stored);
    return ok();
  }
  if (words[0] == "stuck") {
    if (words[1] != "on" && words[1] != "off") return fail(ErrorCode::InvalidArgument, "stuck on or off");
    stuck_ = words[1] == "on";
    return ok();
  }
  return fail(ErrorCode::InvalidArgument, "unknown fault");
}

void BaseDevice::do_heal() noexcept {
  attitude_noise_rad_ = position_noise_m_ = 0;
  stuck_ = false;
}

std::string BaseDevice::do_truth() const {
  if (joints_ == nullptr || !joints_->has_world()) return "no_world=1";
  const MujocoRobot& robot = joints_->robot();
  const FloatingBase& base = robot.base();
  const auto place = base.position_m(robot.data()), rate = base.rate_rad_s(robot.data()),
             wheels = base.wheels_n_m_s(robot.data());
  const auto turned = base.orientation(robot.data());
  const auto all = base.momentum(robot.model(), robot.data());
  return fmt::format(
      "x={:.7f} y={:.7f} z={:.7f} qw={:.9f} qx={:.9f} qy={:.9f} qz={:.9f} rate_x={:.9f} rate_y={:.9f} rate_z={:.9f} "
      "wheel_x={:.6f} wheel_y={:.6f} wheel_z={:.6f} angular_x={:.9f} angular_y={:.9f} angular_z={:.9f} linear_x={:.9f} "
      "linear_y={:.9f} linear_z={:.9f} output={} flags={}",
      place[0], place[1], place[2], turned[0], turned[1], turned[2], turned[3], rate[0], rate[1], rate[2], wheels[0],
      wheels[1], wheels[2], all.angular_n_m_s[0], all.angular_n_m_s[1], all.angular_n_m_s[2], all.linear_n_s[0],
      all.linear_n_s[1], all.linear_n_s[2], static_cast<int>(output()), flags());
}

}  // namespace hirosco::simulation
