// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/relative_encoders.hpp"

#include <utility>

namespace hirosco::simulation {
namespace {

constexpr double farthest_drawn = 3;

}  // namespace

RelativeEncoders::RelativeEncoders(std::vector<double> marks, std::optional<std::vector<double>> begin_at,
                                   std::uint64_t seed)
    : begin_at_{std::move(begin_at)}, random_{seed} {
  for (const double mark : marks) joints_.push_back({.mark = mark});
}

void RelativeEncoders::forget() noexcept {
  for (Joint& joint : joints_) joint = {.mark = joint.mark};
}

double RelativeEncoders::read(std::size_t joint, double position) noexcept {
  Joint& its = joints_[joint];
  if (!its.is_on) {
    its.ahead = position - (begin_at_ ? (*begin_at_)[joint] : random_.uniform(-farthest_drawn, farthest_drawn));
    its.last = position;
    its.is_on = true;
  }
  const bool passes = (its.last - its.mark) * (position - its.mark) <= 0;
  if (passes && its.takes_zero) its.knows_zero = true, its.ahead = 0;
  its.last = position;
  return position - its.ahead;
}

}  // namespace hirosco::simulation
