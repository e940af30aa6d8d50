// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/coupling.hpp"

namespace hirosco::manipulator {

Result<> Coupling::check_length(std::size_t joints) const noexcept {
  const std::size_t length = handle_.value().position_rad.size();
  if (length != joints)
    return fail(ErrorCode::Mismatch, "the required set's POSITION has another length than DES_POSITION",
                static_cast<std::int64_t>(length));
  return ok();
}

void Coupling::engage(const Joints& desired_rad) noexcept {
  following_ = false;
  engage_clutch(desired_rad);
}

/// From here the handle moves the setpoint: neither the handle's angle now nor a link that was away makes it jump.
void Coupling::engage_clutch(const Joints& desired_rad) noexcept {
  clutch_.engage(desired_rad, handle_.value().position_rad);
  parameters_.clutch.store({clutch_.joint_rad(), clutch_.handle_rad()});
}

std::optional<Joints> Coupling::follow(const Joints& desired_rad) noexcept {
  const bool enabled = handle_.valid() && handle_.value().enable != 0;
  if (enabled && !following_) engage_clutch(desired_rad);
  following_ = enabled;
  if (!enabled) return std::nullopt;  // hold the last setpoint
  return clutch_.desired(handle_.value().position_rad, parameters_.position_scale.load());
}

}  // namespace hirosco::manipulator
