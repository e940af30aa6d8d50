// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_contact.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

/// As of the arm that stands: joints and wrist feel one contact at different times, in so many cycles it is the same one.
constexpr std::uint32_t one_contact = 100;

}  // namespace

void FloatingContact::begin(double cycle_s) {
  observer_.emplace(parts_.known.model().joint_count(), cycle_s, observer_gain_per_s);
  forget();
  arm(JointContact::Before::Counts);
}

void FloatingContact::forget() noexcept {
  if (!observer_) return;
  observer_->reset();
  parts_.parameters.external_torque.store(joints_of(observer_->external()));
}

void FloatingContact::update(bool driven) noexcept {
  since_answered_ = std::min(since_answered_ + 1, one_contact);
  if (!feels_ || !observer_) return;
  if (!driven) return forget();
  const SampleTime::Between between = parts_.drives.sample_time().between();
  if (between.s > 0)
    observer_->update(parts_.drives.measured(), parts_.craft.model().inertia(), parts_.craft.bias(),
                      JointVector::Zero(parts_.drives.measured().velocity.size()), between);
  parts_.parameters.external_torque.store(joints_of(observer_->external()));
}

void FloatingContact::arm(JointContact::Before load) noexcept {
  stands_apart_ = false;
  since_answered_ = one_contact;
  parts_.wrist.arm(load == JointContact::Before::Stands);
  if (!observer_) return;
  felt_.arm(load, observer_->external(), parts_.known.bounds(),
            {.contact = parts_.parameters.contact.load().limit, .torque = parts_.parameters.limits.load().torque});
}

void FloatingContact::stand_apart() noexcept {
  arm(JointContact::Before::Counts);
  stands_apart_ = true;
}

std::optional<JointContact::Contact> FloatingContact::meet() noexcept {
  const ContactValues values = parts_.parameters.contact.load();
  if (!offered_ || values.reaction == static_cast<std::uint8_t>(JointContact::Reaction::None)) return std::nullopt;
  return felt_.meet(observer_->external(), parts_.known.bounds(), values.limit);
}

bool FloatingContact::is_another(bool at_wrist) noexcept {
  if (since_answered_ < one_contact && at_wrist != felt_at_wrist_) return false;
  since_answered_ = 0;
  felt_at_wrist_ = at_wrist;
  return true;
}

JointContact::Reaction FloatingContact::reaction() const noexcept {
  if (stands_apart_) return JointContact::Reaction::Stop;
  return static_cast<JointContact::Reaction>(parts_.parameters.contact.load().reaction);
}

void FloatingContact::set(std::uint8_t reaction, double limit) noexcept {
  parts_.parameters.contact.store({reaction, limit});
  arm(JointContact::Before::Counts);
}

}  // namespace hirosco::robot_arm
