// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "robotics/urdf/findings.hpp"
#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics::urdf {
namespace {

using Names = std::unordered_map<std::string_view, std::size_t>;

template <class List, class Name>
[[nodiscard]] Names by_name(const List& list, Name name, const char* what, Findings& findings) {
  Names names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto& [text, at] = name(list[i]);
    if (text.empty()) continue;  // said already
    const auto [found, is_new] = names.try_emplace(text, i);
    if (!is_new)
      findings.error(at, "U0201",
                     std::string{"a second "} + what + " " + in_quotes(text) + "; the first is in line " +
                         std::to_string(name(list[found->second]).second.line),
                     "rename one");
  }
  return names;
}

/// Which joint each link is the child of. False: some name was wrong.
[[nodiscard]] bool find_links(const Names& names, const Robot& robot, std::vector<NamedJoint>& joints,
                              std::vector<const NamedJoint*>& above, Findings& findings) {
  bool good = true;
  for (NamedJoint& named : joints) {
    const auto find = [&](const std::string& link, Location at, std::size_t& index) {
      if (link.empty()) return false;
      const auto found = names.find(link);
      if (found == names.end()) {
        findings.error(
            at, "U0202",
            "joint " + in_quotes(named.joint.name) + " names link " + in_quotes(link) + ", which is not there",
            "add the link, or name another");
        return false;
      }
      index = found->second;
      return true;
    };
    const bool parent = find(named.parent, named.parent_at, named.joint.parent);
    const bool child = find(named.child, named.child_at, named.joint.child);
    good = good && parent && child;
    if (!child) continue;
    const NamedJoint*& first = above[named.joint.child];
    if (first != nullptr) {
      findings.error(named.child_at, "U0203",
                     "link " + in_quotes(robot.links[named.joint.child].name) + " is the child of two joints, " +
                         in_quotes(first->joint.name) + " and " + in_quotes(named.joint.name),
                     "a robot is a tree: closed chains are not supported");
      good = false;
    } else first = &named;
  }
  return good;
}

/// One root, and all hang on it.
[[nodiscard]] bool find_root(Robot& robot, const std::vector<NamedJoint>& joints,
                             const std::vector<const NamedJoint*>& above, Findings& findings) {
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < above.size(); ++i)
    if (above[i] == nullptr) roots.push_back(i);
  if (roots.empty()) {
    findings.error(robot.links.front().at, "U0205",
                   "every link is the child of a joint: they carry each other in a circle",
                   "one link is the base, which no joint has as its child");
    return false;
  }
  if (roots.size() > 1) {
    std::string names;
    for (std::size_t i = 0; i < std::min<std::size_t>(roots.size(), 5); ++i)
      names += (i == 0 ? "" : ", ") + in_quotes(robot.links[roots[i]].name);
    findings.error(
        robot.links[roots[1]].at, "U0204",
        std::to_string(roots.size()) + " links are the child of no joint: " + names + (roots.size() > 5 ? ", ..." : ""),
        "connect them by fixed joints, or remove what does not belong to the robot");
    return false;
  }
  robot.root = roots.front();
  std::vector<std::vector<std::size_t>> below(above.size());
  for (const NamedJoint& named : joints) below[named.joint.parent].push_back(named.joint.child);
  std::vector<std::size_t> reached{robot.root};
  for (std::size_t i = 0; i < reached.size(); ++i)
    reached.insert(reached.end(), below[reached[i]].begin(), below[reached[i]].end());
  if (reached.size() == above.size()) return true;
  std::vector<bool> hangs(above.size(), false);
  for (const std::size_t link : reached) hangs[link] = true;
  const auto lost = static_cast<std::size_t>(std::ranges::find(hangs, false) - hangs.begin());
  findings.error(robot.links[lost].at, "U0205",
                 "link " + in_quotes(robot.links[lost].name) + " and those that carry it carry each other in a circle",
                 "each link hangs on one that is nearer to " + in_quotes(robot.links[robot.root].name));
  return false;
}

/// Chains of mimic joints lead to one that moves by itself.
void find_mimicked(std::vector<NamedJoint>& joints, const Names& names, Findings& findings) {
  for (NamedJoint& named : joints) {
    if (!named.joint.mimic) continue;
    Mimic whole = *named.joint.mimic;
    const NamedJoint* followed = &named;
    // As many steps as there are joints: more is a circle.
    for (std::size_t steps = 0;; ++steps) {
      if (followed->mimicked.empty()) break;  // said already
      const auto found = names.find(followed->mimicked);
      if (found == names.end() || joints[found->second].joint.type == JointType::Fixed || steps > joints.size()) {
        const bool there = found != names.end();
        const bool circle = there && steps > joints.size();
        findings.error(named.mimic_at, "U0308",
                       "joint " + in_quotes(named.joint.name) +
                           (circle ? " mimics itself, over others"
                                   : " mimics " + in_quotes(followed->mimicked) +
                                         (there ? ", which is fixed" : ", which is not there")),
                       "name a joint that moves by itself");
        break;
      }
      followed = &joints[found->second];
      whole.joint = found->second;
      if (!followed->joint.mimic) {
        const double factor = std::abs(whole.multiplier);
        if (factor < smallest_multiplier || factor > largest_number || std::abs(whole.offset) > largest_number)
          findings.error(named.mimic_at, "U0308",
                         "joint " + in_quotes(named.joint.name) +
                             " hardly moves with the one that it mimics, or beyond all bounds",
                         "check multiplier and offset along the chain");
        named.joint.mimic = whole;
        // Names lead on from here in one step for those that come later.
        named.mimicked = followed->joint.name;
        break;
      }
      whole.offset += whole.multiplier * followed->joint.mimic->offset;
      whole.multiplier *= followed->joint.mimic->multiplier;
    }
  }
}

[[nodiscard]] bool moves(const Joint& joint) { return joint.type != JointType::Fixed; }

/// Every joint moves something that has mass, and there are as many as there is room for.
void check_motion(const Robot& robot, Findings& findings) {
  const auto own = std::ranges::count_if(robot.joints, [](const Joint& joint) { return moves(joint) && !joint.mimic; });
  const auto all = std::ranges::count_if(robot.joints, moves);
  const Location at = robot.links[robot.root].at;
  if (own == 0)
    findings.error(at, "U0309", "no joint moves",
                   "a robot has 1 to " + std::to_string(max_joints) + " joints that move by themselves");
  if (own > max_joints || all > max_moved_bodies) {
    findings.error(
        at, "U0309",
        std::to_string(own) + " joints move by themselves and " + std::to_string(all - own) + " by mimicking them",
        "at most " + std::to_string(max_joints) + " by themselves and " + std::to_string(max_moved_bodies) +
            " in all: make those fixed that are not needed");
    return;
  }
  std::vector<double> carried(robot.links.size(), 0);
  std::vector<std::size_t> above(robot.links.size(), robot.joints.size());
  for (std::size_t i = 0; i < robot.joints.size(); ++i) above[robot.joints[i].child] = i;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const auto& inertia = robot.links[i].inertia;
    const bool has_mass = inertia && (inertia->mass > 0 || inertia->about_centre.diagonal().maxCoeff() > 0);
    if (!has_mass && robot.links[i].has_shape)
      findings.warning(robot.links[i].at, "U0503",
                       "link " + in_quotes(robot.links[i].name) + " has a shape, but no mass",
                       "it is taken as massless; give it an <inertial>");
    if (!has_mass) continue;
    for (std::size_t link = i; carried[link] == 0;) {
      carried[link] = 1;
      if (above[link] == robot.joints.size()) break;
      link = robot.joints[above[link]].parent;
    }
  }
  if (!findings.good()) return;
  for (const Joint& joint : robot.joints)
    if (moves(joint) && carried[joint.child] == 0)
      findings.error(
          joint.at, "U0310",
          "joint " + in_quotes(joint.name) + " moves nothing that has mass: how it accelerates is not defined",
          "give link " + in_quotes(robot.links[joint.child].name) + " an <inertial>, or make the joint fixed");
}

/// Whatever is fixed to each other moves as one body, and that must have the inertia of one.
void check_bodies(const Robot& robot, Findings& findings) {
  const ModelDescription description = describe(robot);
  const auto check = [&](const Inertia& body, const Link& link) {
    if (is_body(body)) return;
    findings.error(link.at, "U0306",
                   "the inertia of link " + in_quotes(link.name) +
                       ", with what is fixed to it, is not positive semi-definite: turning about some axis would take "
                       "energy out of nothing",
                   "its principal moments must all be at least 0; check signs and units (kg m2)");
  };
  check(description.base, robot.links[robot.root]);
  auto described = description.joints.begin();
  for (const Joint& joint : robot.joints)
    if (moves(joint)) check((described++)->moved, robot.links[joint.child]);
}

}  // namespace

void connect(Robot& robot, std::vector<NamedJoint>& joints, Findings& findings) {
  const auto links = by_name(
      robot.links, [](const Link& link) { return std::pair<std::string_view, Location>{link.name, link.at}; }, "link",
      findings);
  const auto names = by_name(
      joints,
      [](const NamedJoint& named) { return std::pair<std::string_view, Location>{named.joint.name, named.joint.at}; },
      "joint", findings);
  if (robot.links.empty()) return;
  std::vector<const NamedJoint*> above(robot.links.size(), nullptr);
  const bool known = find_links(links, robot, joints, above, findings) && links.size() == robot.links.size();
  const bool connected = known && find_root(robot, joints, above, findings);
  find_mimicked(joints, names, findings);
  robot.joints.reserve(joints.size());
  for (const NamedJoint& each : joints) robot.joints.push_back(each.joint);
  if (connected) check_motion(robot, findings);
  if (connected && findings.good()) check_bodies(robot, findings);
}

}  // namespace hirosco::robotics::urdf
