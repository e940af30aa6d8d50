// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/tests/rokviss_loop.hpp"

#include <algorithm>

namespace hirosco::simulation {
namespace {

const FlowAddress robot_address{Transfer::SharedMemory, "robot"};
const FlowAddress joystick_address{Transfer::SharedMemory, "joystick"};
constexpr Duration cycle = std::chrono::microseconds{500};

Vec2 get(OctetReader& reader) noexcept {
  const double first = reader.get<double>();
  return {first, reader.get<double>()};
}

manipulator::Joints joints(const Vec2& pair) noexcept { return {pair[0], pair[1]}; }

/// What remains of a motor torque while the joint torque is at its limit: it may relieve the joint, not load it further.
Vec2 relieving(const manipulator::Joints& motor_torque_n_m, const Vec2& joint_torque_n_m, double limit_n_m) noexcept {
  Vec2 torque{motor_torque_n_m[0], motor_torque_n_m[1]};
  for (std::size_t i = 0; i < torque.size(); ++i) {
    if (joint_torque_n_m[i] > limit_n_m) torque[i] = std::min(torque[i], limit_n_m);
    if (joint_torque_n_m[i] < -limit_n_m) torque[i] = std::max(torque[i], -limit_n_m);
  }
  return torque;
}

}  // namespace

RokvissLoop::Sample RokvissLoop::Link::pass(const Sample& written) noexcept {
  samples_[at_ % longest] = written;
  const auto back = static_cast<std::size_t>(cycles_);
  const Sample read = at_ >= back ? samples_[(at_ - back) % longest] : Sample{};
  ++at_;
  return read;
}

RokvissLoop::RokvissLoop(const Settings& settings)
    : settings_{settings},
      robot_{flows_, robot_address, {}, settings.friction ? settings.arm : settings.arm.without_friction()},
      joystick_{flows_, joystick_address, {}, settings.handle},
      display_{settings.passivity ? static_cast<joystick::DisplayLaw&>(passive_position_force_) : position_force_},
      to_manipulator_{settings.link_cycles},
      to_display_{settings.link_cycles} {
  // A pair of mailboxes in memory opens or the caller gave two of the same address; both sides are ours.
  (void)robot_.plug();
  (void)joystick_.plug();
  to_robot_ = std::move(flows_.open(robot_address, FlowSide::Subsystem).value());
  to_joystick_ = std::move(flows_.open(joystick_address, FlowSide::Subsystem).value());
  robot_.step(TimePoint{});
  joystick_.step(TimePoint{});
  trace_.robot.motor_position_rad = trace_.robot.position_rad = settings_.arm.home_rad;
  trace_.desired_rad = settings_.arm.home_rad;
  clutch_.engage(joints(settings_.arm.home_rad), joints({}));
  controller_.reset(joints(settings_.arm.home_rad));
}

void RokvissLoop::read_robot() noexcept {
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = to_robot_->receive(buffer);
  if (!received || received->flow != Flow::New) return;
  const auto status = read_status(Octets{buffer}.first(received->octets));
  if (!status) return;
  OctetReader reader{status->payload, std::endian::little};
  Sensors& robot = trace_.robot;
  for (auto* field : {&robot.motor_position_rad, &robot.motor_velocity_rad_s, &robot.position_rad,
                      &robot.velocity_rad_s, &robot.torque_n_m})
    *field = get(reader);
}

void RokvissLoop::read_joystick() noexcept {
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = to_joystick_->receive(buffer);
  if (!received || received->flow != Flow::New) return;
  const auto status = read_status(Octets{buffer}.first(received->octets));
  if (!status) return;
  OctetReader reader{status->payload, std::endian::little};
  trace_.joystick_rad = get(reader);
  trace_.joystick_rad_s = get(reader);
}

Vec2 RokvissLoop::manipulator_cycle(const Sample& handle) noexcept {
  if (handle.active) {
    const manipulator::Joints desired = clutch_.desired(joints(handle.value), 1.0);
    trace_.desired_rad = {desired[0], desired[1]};
  }
  const Sensors& robot = trace_.robot;
  const auto finding = limit_.update(joints(robot.torque_n_m), settings_.soft_limit_n_m, settings_.hard_limit_n_m);
  if (finding.verdict != manipulator::TorqueVerdict::Fine && !trip_)
    trip_ = Trip{time_s_, finding, robot_.arm().contact().normal_force_n};
  const manipulator::Measured measured{joints(robot.motor_position_rad), joints(robot.motor_velocity_rad_s),
                                       joints(robot.position_rad), joints(robot.velocity_rad_s),
                                       joints(robot.torque_n_m)};
  const manipulator::Joints torque = controller_.motor_torque(joints(trace_.desired_rad), measured, {});
  if (!trip_ || !settings_.reacting) return {torque[0], torque[1]};
  return relieving(torque, robot.torque_n_m, settings_.soft_limit_n_m);  // FC1: in the same cycle
}

void RokvissLoop::command(DataFlow& flow, DeviceMode mode, std::uint32_t sequence, const Vec2& torque_n_m,
                          std::size_t payload_octets) noexcept {
  std::array<std::byte, max_device_payload_octets> payload{};
  OctetWriter writer{payload, std::endian::little};
  writer.put(torque_n_m[0]).put(torque_n_m[1]);
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto frame = write_command(buffer, {mode, 1, sequence, 10'000, Octets{payload}.first(payload_octets)});
  if (frame) (void)flow.send(*frame);
}

void RokvissLoop::step() {
  read_robot();
  read_joystick();
  trace_.contact = robot_.arm().contact();
  trace_.tip_m = robot_.arm().tip_m();
  const Sample handle = to_manipulator_.pass({trace_.joystick_rad, true});
  const Vec2 motor = manipulator_cycle(handle);
  const bool off = torque_off();
  if (trip_) ++cycles_since_trip_;
  const Sample felt = to_display_.pass({trace_.robot.torque_n_m, settings_.reacting ? !trip_ : !off});
  trace_.display_n_m = display_.torque({trace_.joystick_rad_s, felt.value, felt.active}, settings_.force_scale);
  ++cycle_;
  command(*to_robot_, off ? DeviceMode::Off : DeviceMode::Active, cycle_, motor, RobotDevice::command_octets);
  command(*to_joystick_, DeviceMode::Active, cycle_, trace_.display_n_m, JoystickDevice::command_octets);
  const TimePoint now{cycle * cycle_};
  robot_.step(now);
  joystick_.step(now);
  time_s_ = period_s * cycle_;
}

}  // namespace hirosco::simulation
