// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/abort_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace hirosco::robot_arm {
namespace {

/// What is stored with single precision at the end of a range stands beside it by so much at most, rad or m, for each of these.
constexpr double rounding_share = 1e-6;
/// No longer: a failure carries 64 octets of words.
constexpr const char* judged_longer = "to judge it takes longer than ABORT_JUDGING_LIMIT, ms";
/// A refusal has words and one number, which is the joint's.
constexpr std::array<const char*, AbortWay::most> beyond_range{
    "the abort path's posture 1 is out of the range of joint",
    "the abort path's posture 2 is out of the range of joint",
    "the abort path's posture 3 is out of the range of joint",
    "the abort path's posture 4 is out of the range of joint",
    "the abort path's posture 5 is out of the range of joint",
    "the abort path's posture 6 is out of the range of joint",
    "the abort path's posture 7 is out of the range of joint",
    "the abort path's posture 8 is out of the range of joint"};

}  // namespace

bool AbortPath::declared(const descriptor::SubsystemDescriptor& subsystem) {
  return subsystem.find_parameter("ABORT_PATH") != nullptr;
}

bool AbortPath::has_length(std::size_t joints) const noexcept {
  return std::ranges::all_of(stored_.load().postures,
                             [&](const PostureValues& posture) { return posture.joints.size() == joints; });
}

std::size_t AbortPath::most_looks() const noexcept {
  // No time makes half a look; what is a cycle but for its last digits is one.
  return static_cast<std::size_t>(std::max(0.0, std::floor(limit_s_.load() / cycle_s_ + 1e-6)));
}

std::optional<NoWayOut> AbortPath::begin(const JointVector& here, AbortWay::Judged what) noexcept {
  const AbortPathValues stored = stored_.load();
  const std::size_t count = std::min<std::size_t>(stored.count, AbortWay::most);
  tell(0);
  judged_.store(0);
  if (count == 0) return NoWayOut{NoWayOut::Why::NoPath, "no abort path is stored: ABORT_PATH.COUNT is 0"};
  std::array<JointVector, AbortWay::most> postures;
  for (std::size_t i = 0; i < count; ++i) {
    postures[i].resize(here.size());
    std::ranges::copy(stored.postures[i].joints, postures[i].begin());
    if (auto beyond = fit(postures[i], i)) {
      tell(i + 1);
      return beyond;
    }
  }
  way_.begin(std::span{postures}.first(count), here, what, most_looks());
  if (way_.found() == AbortWay::Found::TooLong) return why();
  return std::nullopt;
}

std::optional<NoWayOut> AbortPath::fit(JointVector& posture, std::size_t number) const noexcept {
  const Bounds bounds = parts_.known.bounds();
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    double& its = posture[static_cast<Eigen::Index>(joint)];
    const JointBounds& range = bounds[joint];
    const double off = rounding_share * std::max(1.0, std::abs(its));
    // Written so that what is no number is refused.
    if (!(its >= range.lowest - off && its <= range.highest + off))
      return NoWayOut{NoWayOut::Why::OutOfRange, beyond_range[number], static_cast<std::int64_t>(joint + 1)};
    its = std::clamp(its, range.lowest, range.highest);
  }
  return std::nullopt;
}

AbortWay::Found AbortPath::judge() noexcept {
  if (way_.found() == AbortWay::Found::NotYet)
    way_.heed(way_.by_itself() ? parts_.obstacles.too_near(way_.then())
                               : parts_.obstacles.nearer(way_.before(), way_.then()));
  judged_.store(way_.progress());
  if (way_.found() == AbortWay::Found::Nothing) tell(way_.blocked() + 1);
  return way_.found();
}

NoWayOut AbortPath::why() const noexcept {
  if (way_.found() == AbortWay::Found::TooLong)
    return {NoWayOut::Why::TooSlow, judged_longer, static_cast<std::int64_t>(std::llround(1e3 * limit_s_.load()))};
  const auto& near = way_.in_the_way();
  return {NoWayOut::Why::TooNear, near.names, millimetres(near.distance_m)};
}

}  // namespace hirosco::robot_arm
