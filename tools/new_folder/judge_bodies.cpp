// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>

#include "tools/new_folder/bodies.hpp"

namespace hirosco::tools {

namespace {

using robotics::urdf::JointType;

/// Of moments: the world takes what is on the border, and nothing beyond.
constexpr double rounding = 1e-12;
/// kg, kg m2: what is less is nothing to the world, which takes a link without any moment, but none with two of them.
constexpr double least_mass = 1e-15, least_moment = 1e-14;

[[nodiscard]] robotics::Vector3 principal_moments(const robotics::Inertia& inertia) {
  return Eigen::SelfAdjointEigenSolver<robotics::Matrix3>{inertia.about_centre, Eigen::EigenvaluesOnly}.eigenvalues();
}

[[nodiscard]] bool may_be(const robotics::Inertia& inertia) {
  if (inertia.about_centre.isZero(0)) return true;
  const auto moments = principal_moments(inertia);
  const double largest = moments.maxCoeff();
  return moments.minCoeff() >= least_moment && largest <= (moments.sum() - largest) * (1 + rounding);
}

/// All three moments, in the link or in one that is fixed to it.
[[nodiscard]] bool has_body(const robotics::urdf::Robot& robot, std::size_t link) {
  if (const auto& inertia = robot.links[link].inertia)
    if (inertia->mass >= least_mass && principal_moments(*inertia).minCoeff() >= least_moment) return true;
  return std::ranges::any_of(robot.joints, [&](const auto& joint) {
    return joint.parent == link && joint.type == JointType::Fixed && has_body(robot, joint.child);
  });
}

/// It has no moment about any axis, with what is fixed to it, and carries whoever has: the world asks no more of links between the axes of a
/// shoulder (docs/adr/0211).
[[nodiscard]] bool is_between(const robotics::urdf::Robot& robot, std::size_t link) {
  std::vector<std::size_t> body{link};
  bool carries = false;
  for (std::size_t i = 0; i < body.size(); ++i) {
    if (const auto& inertia = robot.links[body[i]].inertia; inertia && !inertia->about_centre.isZero(0)) return false;
    for (const auto& joint : robot.joints) {
      if (joint.parent != body[i]) continue;
      if (joint.type == JointType::Fixed) body.push_back(joint.child);
      else carries = true;
    }
  }
  return carries;
}

}  // namespace

std::vector<RefusedBody> refused_bodies(const robotics::urdf::Robot& robot) {
  std::vector<RefusedBody> refused;
  const auto whole = robotics::urdf::describe(robot);
  const auto body_of = [&](const std::string& link) -> const robotics::Inertia& {
    const auto frame = std::ranges::find(whole.frames, link, &robotics::FrameDescription::name);
    return frame != whole.frames.end() && frame->joint ? whole.joints[*frame->joint].moved : whole.base;
  };
  for (const auto& link : robot.links) {
    if (!link.inertia || may_be(*link.inertia) || may_be(body_of(link.name))) continue;
    const auto moments = principal_moments(*link.inertia);
    refused.push_back(
        {link.name, "U0604",
         fmt::format("no body has the inertia of link '{}': principal moments {:.4g}, {:.4g} and {:.4g} kg m2",
                     link.name, moments[0], moments[1], moments[2]),
         "each is above 0 and at most the sum of the others, of it or of all that is fixed to it; the world of a "
         "simulated flight takes no other: look for a typing error or a wrong unit"});
  }
  for (const auto& joint : robot.joints) {
    if (joint.type == JointType::Fixed || has_body(robot, joint.child) || is_between(robot, joint.child)) continue;
    const std::string& link = robot.links[joint.child].name;
    refused.push_back(
        {link, "U0607",
         fmt::format("joint '{}' moves link '{}', which has no mass or no inertia about some axis", joint.name, link),
         "the world of a simulated flight wants all of it in one link, this or one that is fixed to it: "
         "write <inertial> as of a body of this size"});
  }
  return refused;
}

}  // namespace hirosco::tools
