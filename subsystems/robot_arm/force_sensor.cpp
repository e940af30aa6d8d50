// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/force_sensor.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// What is older is no measure of a contact.
constexpr std::uint32_t oldest_ms = 20;
/// A contact lasts as long as one that the joints feel.
constexpr std::uint32_t met_after_cycles = 3;

/// Of what stands no more than this is borne.
[[nodiscard]] Vector3 borne_of(const Vector3& standing, double most) noexcept {
  const double norm = standing.norm();
  return norm > most ? Vector3{most / norm * standing} : Vector3{Vector3::Zero()};
}

/// A load that stood is gone when so much of the limit is left of it, as the joints count one.
constexpr double wrist_gone_share = 0.5;
void let_go_of(Vector3& borne, const Vector3& felt, double limit) noexcept {
  if (felt.dot(borne) < wrist_gone_share * limit * borne.norm()) borne.setZero();
}

}  // namespace

bool ForceSensor::declared(const descriptor::SubsystemDescriptor& subsystem) {
  return std::ranges::any_of(subsystem.devices, [](const descriptor::Device& device) {
    return device.name == UrdfArm::device &&
           std::ranges::find(device.input, "FORCE", &descriptor::Field::name) != device.input.end();
  });
}

void ForceSensor::arm(bool stands) noexcept {
  contact_cycles_ = 0;
  const double limit = parts_.contact.load().limit;
  const WristRange range = range_.load();
  borne_force_ = stands && valid_ ? borne_of(force_, limit * range.force_n) : Vector3{Vector3::Zero()};
  borne_moment_ = stands && valid_ ? borne_of(moment_, limit * range.moment_n_m) : Vector3{Vector3::Zero()};
}

std::optional<std::uint32_t> ForceSensor::update(const Hanging& hanging) noexcept {
  if (!parts_.drives.tells_force()) return std::nullopt;
  const TipForce says = parts_.drives.force();
  const Vector3 force{says.force_n[0], says.force_n[1], says.force_n[2]};
  const Vector3 moment{says.moment_n_m[0], says.moment_n_m[1], says.moment_n_m[2]};
  valid_ = parts_.drives.alive() && says.age_ms <= oldest_ms && force.allFinite() && moment.allFinite();
  force_.setZero();
  moment_.setZero();
  if (valid_) {
    force_ = hanging.tip * force - hanging.weight_n;
    moment_ = hanging.tip * moment - hanging.lever_m.cross(hanging.weight_n);
  }
  told_.store({{force_.x(), force_.y(), force_.z()},
               {moment_.x(), moment_.y(), moment_.z()},
               says.age_ms,
               static_cast<std::uint8_t>(valid_ ? 1 : 0)});
  const bool lost = was_valid_ && !valid_;
  was_valid_ = valid_;
  if (!lost) return std::nullopt;
  arm(false);
  return says.age_ms;
}

std::optional<ForceSensor::Contact> ForceSensor::meet(bool floats) noexcept {
  const ContactValues watch = parts_.contact.load();
  if (!valid_ || watch.reaction == 0) return std::nullopt;
  const WristRange range = range_.load();
  let_go_of(borne_force_, force_, watch.limit * range.force_n);
  let_go_of(borne_moment_, moment_, watch.limit * range.moment_n_m);
  const Contact felt{(force_ - borne_force_).norm(), (moment_ - borne_moment_).norm()};
  if (felt.force_n <= watch.limit * range.force_n && felt.moment_n_m <= watch.limit * range.moment_n_m) {
    contact_cycles_ = 0;
    return std::nullopt;
  }
  contact_cycles_ = std::min(contact_cycles_ + 1, met_after_cycles + 1);
  if (contact_cycles_ != met_after_cycles || floats) return std::nullopt;
  return felt;
}

}  // namespace hirosco::robot_arm
