// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/contact_watch.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

/// Joints and wrist feel one contact at different times: cycles in which it is the same one, five times those of the observer at 1 kHz.
constexpr std::uint32_t one_contact = 100;

}  // namespace

void ContactWatch::arm(Yielding::Before load) noexcept {
  parts_.yielding.arm(load);
  parts_.force_sensor.arm(load == Yielding::Before::Stands);
  since_answered_ = one_contact;
}

ContactWatch::Met ContactWatch::meet() noexcept {
  Met met{.by_joints = parts_.yielding.meet(), .at_wrist = parts_.force_sensor.meet(parts_.control.floats())};
  since_answered_ = std::min(since_answered_ + 1, one_contact);
  const bool felt = met.at_wrist.has_value();
  if (!met.by_joints && !felt) return met;
  // Whoever told of it first may tell of another one at any time.
  const bool answered = parts_.guidance.retracting() || parts_.guidance.waits();
  if (answered && since_answered_ < one_contact && felt != felt_at_wrist_) return met;
  since_answered_ = 0;
  felt_at_wrist_ = felt;
  met.counts = true;
  return met;
}

}  // namespace hirosco::robot_arm
