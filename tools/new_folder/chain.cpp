// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/chain.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "hirosco/xml/reader.hpp"
#include "tools/new_folder/other_values.hpp"

namespace hirosco::tools {

namespace {

/// A robot with more different chains than these has more than anybody reads.
constexpr std::size_t most_tried = 64;

struct NamedJoint {
  std::string name, parent, child, followed;
  const xml::Attribute* type{nullptr};
  [[nodiscard]] bool moves() const { return type != nullptr && type->value != "fixed"; }
};

[[nodiscard]] std::string named(const xml::Element& element, std::string_view child, std::string_view attribute) {
  for (const xml::Element& one : element.children)
    if (const auto* found = one.name == child ? one.find(attribute) : nullptr) return found->value;
  return {};
}

/// By the links that they carry.
[[nodiscard]] std::map<std::string, NamedJoint> joints_of(const xml::Element& robot) {
  std::map<std::string, NamedJoint> joints;
  for (const xml::Element& element : robot.children) {
    const auto* name = element.name == "joint" ? element.find("name") : nullptr;
    if (name == nullptr) continue;
    NamedJoint joint{name->value, named(element, "parent", "link"), named(element, "child", "link"),
                     named(element, "mimic", "joint"), element.find("type")};
    joints.emplace(joint.child, std::move(joint));
  }
  return joints;
}

/// From the link to the root; of a file that goes in circles as many as there are.
template <class Visit>
void each_below(const std::map<std::string, NamedJoint>& joints, std::string link, const Visit& visit) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto found = joints.find(link);
    if (found == joints.end()) return;
    visit(found->second);
    link = found->second.parent;
  }
}

/// Joints that move the link by themselves.
[[nodiscard]] std::size_t moved_by(const std::map<std::string, NamedJoint>& joints, const std::string& link) {
  std::size_t count = 0;
  each_below(joints, link, [&](const NamedJoint& below) { count += below.moves() && below.followed.empty(); });
  return count;
}

/// The link at which whatever moves this one hangs; empty: nothing moves it.
[[nodiscard]] std::string carrier_of(const std::map<std::string, NamedJoint>& joints, const std::string& link) {
  std::string carrier;
  each_below(joints, link, [&](const NamedJoint& below) {
    if (carrier.empty() && below.moves()) carrier = below.parent;
  });
  return carrier;
}

}  // namespace

std::vector<ChainEnd> chain_ends(std::string_view text) {
  const auto robot = xml::read_tree(text);
  if (!robot) return {};
  const auto joints = joints_of(*robot);
  std::vector<ChainEnd> ends;
  for (const auto& [link, joint] : joints) {
    if (std::ranges::any_of(joints, [&](const auto& one) { return one.second.parent == link; })) continue;
    if (const std::size_t count = moved_by(joints, link); count > 0) ends.push_back({link, count});
  }
  std::ranges::stable_sort(ends, std::ranges::greater{}, &ChainEnd::joints);
  return ends;
}

std::vector<ChainEnd> chains_that_fly(std::string_view text, std::size_t most, const JointsThatFly& joints_that_fly) {
  const auto robot = xml::read_tree(text);
  if (!robot) return {};
  const auto joints = joints_of(*robot);
  std::set<std::vector<std::string>> tried;
  std::vector<ChainEnd> found;
  for (const ChainEnd& end : chain_ends(text)) {
    for (std::string link = end.link; 2 * moved_by(joints, link) > end.joints; link = carrier_of(joints, link)) {
      if (found.size() == most || tried.size() == most_tried) break;
      const Chain chain = keep_chain(text, link, {});
      // Whoever was the same before either flies, or was followed towards its root already.
      if (!tried.insert(chain.standing).second) break;
      const std::size_t count = joints_that_fly(chain.urdf, link);
      if (count == 0) continue;
      found.push_back({link, count});
      break;
    }
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &ChainEnd::joints);
  return found;
}

bool has_link(std::string_view text, const std::string& link) {
  const auto robot = xml::read_tree(text);
  return robot && std::ranges::any_of(robot->children, [&](const xml::Element& element) {
           const auto* name = element.name == "link" ? element.find("name") : nullptr;
           return name != nullptr && name->value == link;
         });
}

Chain keep_chain(std::string_view text, const std::string& tip, std::span<const std::string> joints) {
  Chain chain{std::string{text}, {}};
  const auto robot = xml::read_tree(text);
  if (!robot) return chain;
  const auto all = joints_of(*robot);
  std::set<std::string> kept{joints.begin(), joints.end()};
  const auto keep = [&](const NamedJoint& below) { kept.insert(below.name); };
  each_below(all, tip, keep);
  for (const auto& [link, joint] : all)
    if (std::ranges::find(joints, joint.name) != joints.end()) each_below(all, link, keep);
  // Whom one of them follows, whom that one follows, ...; who follows a joint that is named, as fingers do.
  for (std::size_t before = 0; before != kept.size();) {
    before = kept.size();
    for (const auto& [link, joint] : all) {
      if (joint.followed.empty()) continue;
      if (kept.contains(joint.name)) kept.insert(joint.followed);
      else if (std::ranges::find(joints, joint.followed) != joints.end()) kept.insert(joint.name);
    }
  }
  std::vector<OtherValue> values;
  for (const xml::Element& element : robot->children) {
    const auto *name = element.find("name"), *type = element.find("type");
    if (element.name != "joint" || name == nullptr || type == nullptr) continue;
    if (type->value == "fixed" || kept.contains(name->value)) continue;
    chain.standing.push_back(name->value);
    values.push_back({type->value_at, "fixed"});
  }
  chain.urdf = with_values(text, values);
  return chain;
}

}  // namespace hirosco::tools
