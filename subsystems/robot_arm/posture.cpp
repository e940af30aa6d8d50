// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/posture.hpp"

namespace hirosco::robot_arm {
namespace {

constexpr const char* beyond_its_range = "POSTURE is out of the range of joint";

}  // namespace

bool Posture::declared(const descriptor::SubsystemDescriptor& subsystem) {
  return subsystem.find_parameter("POSTURE") != nullptr;
}

Result<> Posture::check(const descriptor::SubsystemDescriptor& subsystem) const noexcept {
  if (!declared(subsystem)) return ok();
  if (joints_.load().size() != known_.joints())
    return fail(ErrorCode::Mismatch, "POSTURE has another length than the robot has joints",
                static_cast<std::int64_t>(joints_.load().size()));
  if (const auto why = unfit(preferred())) return fail(ErrorCode::OutOfRange, why->text, why->number);
  return ok();
}

std::optional<Reason> Posture::unfit(const PreferredPosture& preferred) const noexcept {
  if (!preferred.counts()) return std::nullopt;
  const Bounds bounds = known_.bounds();
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const double its = preferred.joints[static_cast<Eigen::Index>(joint)];
    // Written so that what is no number is refused.
    if (!(its >= bounds[joint].lowest && its <= bounds[joint].highest))
      return Reason{Trouble::out_of_range, beyond_its_range, static_cast<std::int64_t>(joint + 1)};
  }
  return std::nullopt;
}

}  // namespace hirosco::robot_arm
