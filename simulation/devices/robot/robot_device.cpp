// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/robot/robot_device.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

constexpr double over_temperature_c = 80;
constexpr double gear_ratio = 160;
constexpr double encoder_step_rad = 2 * std::numbers::pi / 131'072;  // 17 bit

double quantized(double angle_rad, double step_rad) noexcept { return std::round(angle_rad / step_rad) * step_rad; }

void put(OctetWriter& writer, const Vec2& values) noexcept { writer.put(values[0]).put(values[1]); }

}  // namespace

RobotDevice::RobotDevice(FlowFactory& flows, FlowAddress address, const Settings& settings, const ArmParameters& arm,
                         const RobotSensors& sensors)
    : SimulatedDevice{flows, std::move(address), settings},
      arm_{arm},
      sensors_{sensors},
      made_noise_n_m_{sensors.torque_noise_n_m},
      made_thermal_acceleration_{arm.thermal.acceleration},
      random_{settings.seed} {}

Result<> RobotDevice::take(OctetReader payload) noexcept {
  const Vec2 torque{payload.get<double>(), payload.get<double>()};
  const auto spring = payload.get<std::uint8_t>();
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "robot command size");
  for (std::size_t i = 0; i < 2; ++i) commanded_[i] = std::isfinite(torque[i]) ? torque[i] : 0;
  if (spring != spring_asked_) ask_for(spring);
  return ok();
}

void RobotDevice::ask_for(std::uint8_t spring) noexcept {
  spring_asked_ = spring;
  if (spring == 0) arm_.release_spring();
  else if (!arm_.hooked_spring()) static_cast<void>(arm_.hook_spring(std::size_t{spring} - 1));
}

/// Of the joints' own electronics, which know motor rate and joint torque: damped and giving way at first, so that nothing
/// that is pressed or hooked is torn at; towards the end the load of that moment is held, damped still.
Vec2 RobotDevice::coming_to_rest() noexcept {
  constexpr double damping_n_m_s = 24, soft_n_m_per_rad = 600,
                   torque_feedback = 3;  // motor inertia seen as a quarter, as in service
  const ArmState& state = arm_.state();
  const Vec2 joint = arm_.joint_torque_n_m();
  Vec2 drive = -damping_n_m_s * state.motor_rad_s;
  if (stop_left() <= settings().stop_within / 2) drive = drive + gripping(joint, soft_n_m_per_rad);
  return (1 + torque_feedback) * drive - torque_feedback * joint;
}

/// As friction does: carries the load that was there when it gripped, gives way elastically, slips beyond its torque.
Vec2 RobotDevice::gripping(const Vec2& load_n_m, double stiffness_n_m_per_rad) noexcept {
  const Vec2& motor = arm_.state().motor_rad;
  if (!gripped_rad_) gripped_rad_ = motor + 1 / stiffness_n_m_per_rad * load_n_m;
  Vec2 torque = stiffness_n_m_per_rad * (*gripped_rad_ - motor);
  for (double& held : torque) held = std::clamp(held, -brake_torque_n_m, brake_torque_n_m);
  gripped_rad_ = motor + 1 / stiffness_n_m_per_rad * torque;
  return torque;
}

void RobotDevice::advance(Duration cycle) noexcept {
  constexpr double brake_n_m_per_rad = 4000, brake_damping_n_m_s = 100;
  const DeviceOutput held_before = std::exchange(output_before_, output());
  const double limit = arm_.parameters().joint.torque_max_n_m;
  applied_ = brake_ = {};
  switch (output()) {
    case DeviceOutput::Off: break;
    case DeviceOutput::Active: applied_ = commanded_; break;
    case DeviceOutput::Stopping: applied_ = coming_to_rest(); break;
    case DeviceOutput::Holding:
      if (held_before != DeviceOutput::Holding) gripped_rad_.reset();
      brake_ = gripping(arm_.joint_torque_n_m(), brake_n_m_per_rad) - brake_damping_n_m_s * arm_.state().motor_rad_s;
      for (double& torque : brake_) torque = std::clamp(torque, -brake_torque_n_m, brake_torque_n_m);
      break;
  }
  if (output() == DeviceOutput::Off || output() == DeviceOutput::Active) gripped_rad_.reset();
  raise(device_flag::torque_saturated, std::abs(applied_[0]) > limit || std::abs(applied_[1]) > limit);
  for (double& torque : applied_) torque = std::clamp(torque, -limit, limit);
  arm_.step(applied_ + brake_, cycle);
  const Vec2& celsius = arm_.temperature_c();
  raise(device_flag::over_temperature, std::max(celsius[0], celsius[1]) >= over_temperature_c);
}

void RobotDevice::write_sensors(OctetWriter& payload) noexcept {
  const ArmState& state = arm_.state();
  Vec2 motor = state.motor_rad;
  Vec2 link = state.link_rad;
  Vec2 torque = arm_.joint_torque_n_m();
  for (std::size_t i = 0; i < 2; ++i) {
    if (sensors_.quantized) motor[i] = quantized(motor[i], encoder_step_rad / gear_ratio);
    if (sensors_.quantized) link[i] = quantized(link[i], encoder_step_rad);
    if (sensors_.torque_noise_n_m > 0) torque[i] += sensors_.torque_noise_n_m * random_.normal();
  }
  put(payload, motor);
  put(payload, state.motor_rad_s);
  put(payload, link);
  put(payload, state.link_rad_s);
  put(payload, torque);
  for (const double celsius : arm_.temperature_c()) payload.put(static_cast<float>(celsius));
  const auto hooked = arm_.hooked_spring();
  payload.put(static_cast<std::uint8_t>(hooked ? *hooked + 1 : 0));
}

Result<> RobotDevice::do_fault(const Words& words) {
  const std::string_view what = words[0];
  if (what == "temperature") {
    HIROSCO_TRY(words.expect(3));
    HIROSCO_TRY_LET(const double joint, words.number(1, 1, 2));
    HIROSCO_TRY_LET(const double celsius, words.number(2, -273, 1000));
    arm_.set_temperature(static_cast<std::size_t>(joint) - 1, celsius);
    return ok();
  }
  if (what == "hook") {
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(const double spring, words.number(1, 1, 2));
    if (!arm_.hook_spring(static_cast<std::size_t>(spring) - 1))
      return fail(ErrorCode::Unavailable, "spring not within reach of the tip");
    return ok();
  }
  if (what == "release") {
    HIROSCO_TRY(words.expect(1));
    arm_.release_spring();
    return ok();
  }
  if (what == "friction") {
    HIROSCO_TRY(words.expect(2));
    if (words[1] != "on" && words[1] != "off") return fail(ErrorCode::InvalidArgument, "friction on or off");
    arm_.set_friction(words[1] == "on");
    return ok();
  }
  if (what == "thermal_accel") {
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(const double factor, words.number(1, 0, 1000));
    arm_.set_thermal_acceleration(factor);
    return ok();
  }
  if (what == "noise") {
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(sensors_.torque_noise_n_m, words.number(1, 0, 10));
    return ok();
  }
  return fail(ErrorCode::InvalidArgument, "unknown fault");
}

/// A hooked spring stays: that is where the world is, no fault.
void RobotDevice::do_heal() noexcept {
  for (std::size_t joint = 0; joint < arm_.temperature_c().size(); ++joint)
    arm_.set_temperature(joint, arm_.parameters().thermal.ambient_c);
  arm_.set_thermal_acceleration(made_thermal_acceleration_);
  arm_.set_friction(true);
  sensors_.torque_noise_n_m = made_noise_n_m_;
}

std::string RobotDevice::do_truth() const {
  const Contact contact = arm_.contact();
  const Vec2 tip = arm_.tip_m();
  const Vec2 torque = arm_.joint_torque_n_m();
  return fmt::format(
      "tip_x={:.6f} tip_y={:.6f} force={:.4f} penetration_mm={:.5f} torque_1={:.5f} torque_2={:.5f} "
      "temperature_1={:.2f} temperature_2={:.2f} motor_1={:.4f} motor_2={:.4f} brake_1={:.4f} brake_2={:.4f} "
      "motor_angle_1={:.6f} motor_angle_2={:.6f} angle_1={:.6f} angle_2={:.6f} "
      "output={} flags={}",
      tip[0], tip[1], contact.normal_force_n, 1e3 * contact.penetration_m, torque[0], torque[1],
      arm_.temperature_c()[0], arm_.temperature_c()[1], applied_[0], applied_[1], brake_[0], brake_[1],
      arm_.state().motor_rad[0], arm_.state().motor_rad[1], arm_.state().link_rad[0], arm_.state().link_rad[1],
      static_cast<int>(output()), flags());
}

}  // namespace hirosco::simulation
