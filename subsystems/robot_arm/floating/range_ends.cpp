// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/range_ends.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// Infinite where there is no end.
[[nodiscard]] double left_before_end(const JointBounds& bounds, double position, double rate) noexcept {
  return (rate > 0 ? bounds.highest - position : position - bounds.lowest) - kept_from_end;
}

}  // namespace

double weight_near_end(const JointBounds& bounds, double position, double rate) noexcept {
  const double avoided = std::min(avoided_share * (bounds.highest - bounds.lowest), most_avoided);
  return std::clamp(left_before_end(bounds, position, rate) / avoided, 0.0, 1.0);
}

std::optional<EndAhead> end_ahead(const JointVector& position, const JointVector& rates, Bounds bounds,
                                  double per_s) noexcept {
  const double stops_in_s = std::max(stopped_in_s, times_followed / per_s);
  std::optional<EndAhead> found;
  double most_beyond = 0;
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    if (rates[i] == 0) continue;
    const double left = left_before_end(bounds[joint], position[i], rates[i]);
    const double beyond = std::abs(rates[i]) - std::max(0.0, left) / stops_in_s;
    if (!(beyond > most_beyond)) continue;
    most_beyond = beyond;
    found = {joint, position[i], rates[i] > 0 ? bounds[joint].highest : bounds[joint].lowest};
  }
  return found;
}

}  // namespace hirosco::robot_arm
