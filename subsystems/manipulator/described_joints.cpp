// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/described_joints.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::manipulator {

Result<> DescribedJoints::read(const descriptor::SubsystemDescriptor& arm, std::size_t count) {
  home_rad_ = Joints::zeros(count);
  lowest_rad_ = highest_rad_ = home_rad_;
  const auto& parameters = arm.parameters;
  const auto position = std::ranges::find(parameters, "DES_POSITION", [](const auto& p) { return p.field.name; });
  if (position == parameters.end() || count == 0) return ok();  // that is told already
  for (std::size_t i = 0; i < std::min(count, position->init.size()); ++i)
    if (const auto* home = std::get_if<Number>(&position->init[i])) home_rad_[i] = home->real();
  const descriptor::Function* move_to = arm.find_function("MOVE_TO");
  if (move_to == nullptr) return fail(ErrorCode::Mismatch, "an arm has the function MOVE_TO");
  std::size_t numbers = 0;
  for (const auto& argument : move_to->arguments)
    for (std::size_t i = 0; i < argument.field.count; ++i, ++numbers) {
      if (numbers >= count) continue;
      lowest_rad_[numbers] = argument.field.minimum.value_or(-HUGE_VAL).real();
      highest_rad_[numbers] = argument.field.maximum.value_or(HUGE_VAL).real();
    }
  if (numbers != count + 1)
    return fail(ErrorCode::Mismatch, "MOVE_TO takes a number for each element of DES_POSITION, and the duration",
                static_cast<std::int64_t>(numbers));
  return ok();
}

Joints DescribedJoints::within_range(Joints position_rad) const noexcept {
  for (std::size_t i = 0; i < position_rad.size(); ++i)
    position_rad[i] = std::clamp(position_rad[i], lowest_rad_[i], highest_rad_[i]);
  return position_rad;
}

}  // namespace hirosco::manipulator
