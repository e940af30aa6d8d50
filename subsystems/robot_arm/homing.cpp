// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/homing.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace hirosco::robot_arm {
namespace {

/// Of a joint's velocity: nobody looks for a mark faster.
constexpr double fastest_search = 0.25;

[[nodiscard]] const descriptor::Device* arm_of(const descriptor::SubsystemDescriptor& subsystem) {
  const auto its = std::ranges::find(subsystem.devices, UrdfArm::device, &descriptor::Device::name);
  return its == subsystem.devices.end() ? nullptr : &*its;
}

[[nodiscard]] Reason reason_of(const HomeSearch::News& news) noexcept {
  const auto joint = static_cast<std::int64_t>(news.joint + 1);
  switch (news.end) {
    case HomeSearch::End::NotFound: return {Trouble::mark_not_found, "no mark within DISTANCE of HOMING, joint", joint};
    case HomeSearch::End::Presses:
      return {Trouble::homing_pressed, "all of TORQUE of HOMING: something is in the way, joint", joint};
    case HomeSearch::End::Lost: return {Trouble::not_referenced, "it lost its zero meanwhile, joint", joint};
    case HomeSearch::End::None:
    case HomeSearch::End::Done: break;
  }
  return {};
}

}  // namespace

bool Homing::told(const descriptor::SubsystemDescriptor& subsystem) {
  const descriptor::Device* arm = arm_of(subsystem);
  return arm != nullptr && std::ranges::find(arm->input, "REFERENCED", &descriptor::Field::name) != arm->input.end();
}

bool Homing::declared(const descriptor::SubsystemDescriptor& subsystem) {
  return std::ranges::any_of(subsystem.configurations, [&](const descriptor::Configuration& each) {
    return std::ranges::any_of(each.devices, [&](const descriptor::DeviceUse& use) {
      return subsystem.devices[use.device].name == UrdfArm::device &&
             std::ranges::find(use.settings, setting, &descriptor::Setting::name) != use.settings.end();
    });
  });
}

Result<> Homing::check_references() const noexcept {
  const std::size_t joints = parts_.known.joints();
  if (references_.size() != joints || referenced_.load().size() != joints)
    return fail(ErrorCode::Mismatch, "REFERENCED has another length than the robot has joints");
  if (parts_.drives.takes_zeros() != joints)
    return fail(ErrorCode::Mismatch, "REFERENCE has another length than the robot has joints");
  return ok();
}

Result<> Homing::check_values() const noexcept {
  const std::size_t joints = parts_.known.joints();
  const HomingValues values = values_.load();
  for (const std::size_t length :
       {values.order.size(), values.speed.size(), values.torque.size(), values.distance.size()})
    if (length != joints)
      return fail(ErrorCode::Mismatch, "a part of HOMING has another length than the robot has joints",
                  static_cast<std::int64_t>(length));
  return ok();
}

Result<> Homing::begin(double cycle_s) {
  search_.reset();
  law_.reset();
  if (!parts_.drives.tells_references()) return ok();
  references_ = parts_.drives.references();
  HIROSCO_TRY(check_references());
  tell_looking();
  const std::string_view said = parts_.drives.port().setting(setting);
  if (said.empty()) return ok();
  if (said != "on")
    return fail(ErrorCode::InvalidArgument, "HOMING of ARM is on, or the configuration does not have it");
  HIROSCO_TRY(check_values());
  if (const auto why = unfit()) return fail(ErrorCode::InvalidArgument, why->text, why->number);
  search_.emplace(cycle_s);
  law_.emplace(parts_.known.model(), cycle_s);
  const JointVector zeros = JointVector::Zero(parts_.known.model().joint_count());
  const Measured nothing{zeros, zeros, zeros};
  search_->begin({.measured = nothing, .referenced = references_});
  return ok();
}

/// Of what may be written before HOME is asked.
std::optional<Reason> Homing::unfit() const noexcept {
  const HomingValues values = values_.load();
  const Joints rotor = parts_.parameters.rotor_inertia.load();
  const Bounds bounds = parts_.known.bounds();
  std::array<bool, max_joints> is_ordered{};
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto number = static_cast<std::int64_t>(joint + 1);
    const auto because = [&](const char* text) { return Reason{Trouble::homing_unfit, text, number}; };
    const std::size_t turn = values.order[joint];
    if (turn < 1 || turn > bounds.size() || std::exchange(is_ordered[turn - 1], true))
      return because("ORDER of HOMING does not name each joint once, at place");
    // Written so that what is no number is unfit.
    const double speed = std::abs(values.speed[joint]);
    if (!(speed > 0 && speed <= fastest_search * bounds[joint].motion.velocity))
      return because("SPEED of HOMING is 0 or above 1/4 of its velocity, joint");
    if (!(values.torque[joint] > 0 && values.torque[joint] <= bounds[joint].effort))
      return because("TORQUE of HOMING is 0 or above its effort, joint");
    if (!(values.distance[joint] > 0)) return because("DISTANCE of HOMING is 0, joint");
    if (!(rotor[joint] > 0)) return because("homing goes by ROTOR_INERTIA, which is 0, joint");
  }
  return std::nullopt;
}

std::optional<Homing::Forbidden> Homing::forbids() const noexcept {
  if (in_force()) {
    const auto gravity = parts_.parameters.gravity_m_s2.load();
    const double strength = Vector3{gravity[0], gravity[1], gravity[2]}.norm();
    return strength == 0 ? std::nullopt : std::optional{Forbidden{.gravity_m_s2 = strength}};
  }
  const auto joint = parts_.drives.not_referenced(parts_.known.joints());
  return joint ? std::optional{Forbidden{.joint = joint}} : std::nullopt;
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

bool Homing::update() noexcept {
  if (!parts_.drives.tells_references()) return false;
  const JointFlags before = std::exchange(references_, parts_.drives.references());
  referenced_.store(references_);
  return !(references_ == before);
}

HomeSearch::Sees Homing::sees() const noexcept {
  return {.measured = parts_.drives.measured(), .referenced = references_, .presses = law_->presses()};
}

void Homing::engage() noexcept {
  law_->begin();
  search_->begin(sees());
}

Homing::News Homing::advance() noexcept {
  const HomeSearch::News news = search_->advance(sees());
  if (news.end == HomeSearch::End::Presses) law_->begin();
  if (news.end == HomeSearch::End::None) return {.found = news.found};
  if (news.end == HomeSearch::End::Done) return {.done = true};
  return {.failed = reason_of(news)};
}

void Homing::end() noexcept {
  if (!search_) return;
  search_->stop();
  tell_looking();
}

/// Whatever was written since it was judged: no more than its effort, and what is no number is none.
Joints Homing::most_torque() const noexcept {
  const Joints said = values_.load().torque;
  const Bounds bounds = parts_.known.bounds();
  Joints most = Joints::zeros(bounds.size());
  for (std::size_t joint = 0; joint < bounds.size(); ++joint)
    if (said[joint] > 0) most[joint] = std::min(said[joint], bounds[joint].effort);
  return most;
}

JointVector Homing::torque(const Setpoint& wanted) noexcept {
  const Joints rotor = parts_.parameters.rotor_inertia.load(), most = most_torque();
  return law_->torque(wanted, parts_.drives.measured(),
                      {.bandwidth_rad_s = parts_.control.bandwidth_rad_s(), .rotor = rotor, .most = most});
}

void Homing::control() noexcept {
  const Setpoint& wanted = search_->now();
  parts_.parameters.desired_position.store(joints_of(wanted.position));
  parts_.parameters.desired_velocity.store(joints_of(wanted.velocity));
  parts_.parameters.bandwidth_in_force.store(parts_.control.bandwidth_rad_s());
  parts_.drives.put_out(joints_of(torque(wanted)));
  tell_looking();
}

/// Device and ground.
void Homing::tell_looking() noexcept {
  JointFlags takes_zero = JointFlags::zeros(parts_.known.joints());
  const auto looking = search_ ? search_->looking() : std::nullopt;
  if (looking) takes_zero[*looking] = 1;
  parts_.drives.take_zero(takes_zero);
  goes_.store(static_cast<std::uint8_t>(looking ? *looking + 1 : 0));
}

double Homing::answer(std::size_t joint, double deviation) noexcept {
  engage();
  Setpoint wanted = search_->now();
  wanted.position[static_cast<Eigen::Index>(joint)] += deviation;
  const JointVector given = torque(wanted);
  parts_.drives.put_out(joints_of(given));
  return given[static_cast<Eigen::Index>(joint)];
}

// --- the function --------------------------------------------------------------------------------------------------------

Outcome Homing::home() noexcept {
  if (const auto why = unfit()) return refused(why->trouble, why->text, why->number);
  const HomingValues values = values_.load();
  std::array<std::uint8_t, max_joints> order{};
  std::array<HomeSearch::Way, max_joints> ways{};
  for (std::size_t i = 0; i < parts_.known.joints(); ++i) {
    order[i] = static_cast<std::uint8_t>(values.order[i] - 1);
    ways[i] = {values.speed[i], values.distance[i]};
  }
  search_->look(std::span{order}.first(parts_.known.joints()), ways);
  return running;
}

}  // namespace hirosco::robot_arm
