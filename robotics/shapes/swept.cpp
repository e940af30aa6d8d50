// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/swept.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace hirosco::robotics {
namespace {

/// Between two places of what turns; the arc between them is added to the hull.
constexpr double step_rad = std::numbers::pi / 12;

/// rad or m
struct Way {
  double lower, upper, stands;
};

[[nodiscard]] double value_at(const urdf::Joint& joint, double leader) {
  return joint.mimic ? joint.mimic->multiplier * leader + joint.mimic->offset : leader;
}

/// What follows goes as far as it is led.
[[nodiscard]] Way way_of(const urdf::Robot& robot, const urdf::Joint& joint) {
  const urdf::Joint& leader = joint.mimic ? robot.joints[joint.mimic->joint] : joint;
  const double lower = leader.limits.lower.value_or(-std::numbers::pi);
  const double upper = leader.limits.upper.value_or(std::numbers::pi);
  const auto [low, high] = std::minmax({value_at(joint, lower), value_at(joint, upper)});
  if (joint.type != urdf::JointType::Prismatic && high - low > 2 * std::numbers::pi)
    return {-std::numbers::pi, std::numbers::pi, value_at(joint, 0)};
  return {low, high, value_at(joint, 0)};
}

[[nodiscard]] Pose moved_by(const urdf::Joint& joint, double value) {
  if (joint.type == urdf::JointType::Prismatic) return {Matrix3::Identity(), value * joint.axis};
  return {Eigen::AngleAxisd{value, joint.axis}.toRotationMatrix(), Vector3::Zero()};
}

[[nodiscard]] RoundedHull placed(const Pose& pose, const RoundedHull& hull) {
  RoundedHull there;
  for (std::size_t i = 0; i < hull.corners(); ++i) static_cast<void>(there.add(pose * hull.corner(i)));
  there.round(hull.radius_m());
  return there;
}

/// One convex hull: also of what is between two places of a body that turns.
[[nodiscard]] RoundedHull swept(const RoundedHull& hull, const urdf::Joint& joint, const Way& way) {
  const bool slides = joint.type == urdf::JointType::Prismatic;
  const double width = way.upper - way.lower;
  const int steps = slides ? 1 : std::max(1, static_cast<int>(std::ceil(width / step_rad)));
  std::vector<Vector3> points;
  double out_m = 0;
  for (std::size_t i = 0; i < hull.corners(); ++i) {
    const Vector3 corner = hull.corner(i);
    out_m = std::max(out_m, (corner - corner.dot(joint.axis) * joint.axis).norm());
    for (int step = 0; step <= steps; ++step)
      points.push_back(moved_by(joint, way.lower + width * step / steps) * corner);
  }
  const double arc_m = slides ? 0 : (out_m + hull.radius_m()) * (1 - std::cos(width / steps / 2));
  RoundedHull all = hull_around(std::move(points));
  all.round(all.radius_m() + hull.radius_m() + arc_m);
  return all;
}

/// Of one robot.
class Sweep {
 public:
  Sweep(const urdf::Robot& robot, std::span<const std::string> standing) : robot_{robot}, standing_{standing} {}

  void sweep(LinkHull& each) const {
    const auto link = std::ranges::find(robot_.links, each.link, &urdf::Link::name);
    if (link == robot_.links.end()) return;
    auto at = static_cast<std::size_t>(link - robot_.links.begin());
    RoundedHull hull = each.hull;
    Pose stands;  // of the link, in the frame of whom the way up has come to
    bool moved = false;
    for (const urdf::Joint* joint = above(at); joint != nullptr; joint = above(at)) {
      if (stands_still(*joint)) {
        const Way way = way_of(robot_, *joint);
        hull = swept(hull, *joint, way);
        stands = moved_by(*joint, way.stands) * stands;
        moved = true;
      } else if (joint->type != urdf::JointType::Fixed) {
        break;
      }
      hull = placed(joint->origin, hull);
      stands = joint->origin * stands;
      at = joint->parent;
    }
    if (moved) each.standing = std::exchange(each.hull, placed(inverse(stands), hull));
  }

 private:
  [[nodiscard]] const urdf::Joint* above(std::size_t link) const {
    const auto found = std::ranges::find(robot_.joints, link, &urdf::Joint::child);
    return found != robot_.joints.end() ? &*found : nullptr;
  }
  /// By itself, or with whom it follows.
  [[nodiscard]] bool stands_still(const urdf::Joint& joint) const {
    if (joint.type == urdf::JointType::Fixed) return false;
    const std::string& leader = joint.mimic ? robot_.joints[joint.mimic->joint].name : joint.name;
    return std::ranges::find(standing_, leader) != standing_.end();
  }

  const urdf::Robot& robot_;
  std::span<const std::string> standing_;
};

}  // namespace

void sweep(std::vector<LinkHull>& hulls, const urdf::Robot& robot, std::span<const std::string> standing) {
  if (standing.empty()) return;
  const Sweep each{robot, standing};
  for (LinkHull& hull : hulls) each.sweep(hull);
}

}  // namespace hirosco::robotics
