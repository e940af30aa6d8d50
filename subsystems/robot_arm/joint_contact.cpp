// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/joint_contact.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// An external torque has to last for a contact, so many cycles.
constexpr std::uint32_t contact_after_cycles = 3;
/// A load that stood is gone when so much of the limit is left of it.
constexpr double gone_share = 0.5;

}  // namespace

/// Of a load that stands no more is borne than the limit, and never so much that the torque limit had to find what comes to it: one motion
/// behind the other presses no harder than the first.
void JointContact::arm(Before load, const JointVector& external, Bounds bounds, const Limits& limits) noexcept {
  cycles_ = 0;
  borne_.resize(0);
  if (load == Before::Counts) return;
  const double limit = limits.contact;
  const double most = std::min(limit, std::max(0.0, limits.torque - limit));
  borne_.setZero(static_cast<Eigen::Index>(bounds.size()));
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double share = external[i] / bounds[joint].effort;
    if (std::abs(share) > limit) borne_[i] = std::clamp(share, -most, most);
  }
}

/// Away from where a load stood nothing more is let through than without it.
double JointContact::counts_from(Eigen::Index joint, double share, double limit) noexcept {
  if (borne_.size() == 0) return limit;
  double& borne = borne_[joint];
  if (share * (borne > 0 ? 1 : -1) < gone_share * limit) borne = 0;
  return limit + std::abs(borne);
}

std::optional<JointContact::Contact> JointContact::meet(const JointVector& external, Bounds bounds,
                                                        double limit) noexcept {
  std::size_t worst = 0;
  double most = 0, most_limit = limit;
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double share = external[i] / bounds[joint].effort;
    const double its = counts_from(i, share, limit);
    if (std::abs(share) - its > most) most = std::abs(share) - its, worst = joint, most_limit = its;
  }
  if (most <= 0) {
    cycles_ = 0;
    return std::nullopt;
  }
  if (++cycles_ != contact_after_cycles) return std::nullopt;
  return Contact{worst, external[static_cast<Eigen::Index>(worst)], most_limit * bounds[worst].effort};
}

}  // namespace hirosco::robot_arm
