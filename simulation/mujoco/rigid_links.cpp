// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/rigid_links.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {
namespace {

using xml::Element;
using Numbers3 = std::array<mjtNum, 3>;
using Matrix = std::array<mjtNum, 9>;

/// What MuJoCo takes as no less than the sum of the others.
constexpr mjtNum rounding = 1e-12;
/// Of a link that moves MuJoCo wants some, kg and kg m2: many times as much, and nothing to any robot.
constexpr mjtNum next_to_no_mass = 1e-9, next_to_no_moment = 1e-12;

[[nodiscard]] std::string said(const Element* element, std::string_view name, const char* otherwise = "") {
  const auto* found = element != nullptr ? element->find(name) : nullptr;
  return found != nullptr ? found->value : otherwise;
}

/// As many as stand there; the others are 0. The strict reader of the arm has seen the file first.
[[nodiscard]] Numbers3 three(const std::string& text) {
  Numbers3 numbers{};
  std::istringstream words{text};
  words.imbue(std::locale::classic());
  for (mjtNum& number : numbers)
    if (!(words >> number)) break;
  return numbers;
}
[[nodiscard]] mjtNum one(const Element* element, std::string_view name) { return three(said(element, name))[0]; }

[[nodiscard]] Matrix times(const Matrix& one, const Matrix& other) {
  Matrix product{};
  mju_mulMatMat(product.data(), one.data(), other.data(), 3, 3, 3);
  return product;
}

struct Frame {
  Numbers3 place{};
  Matrix turned{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

[[nodiscard]] Frame frame_of(const Element& element) {
  const Element* origin = child_of(element, "origin");
  Frame frame{.place = three(said(origin, "xyz")), .turned = {}};
  const Numbers3 angles = three(said(origin, "rpy"));
  std::array<mjtNum, 4> quaternion{};
  mju_euler2Quat(quaternion.data(), angles.data(), "XYZ");
  mju_quat2Mat(frame.turned.data(), quaternion.data());
  return frame;
}
[[nodiscard]] Frame within(const Frame& outer, const Frame& inner) {
  Frame frame;
  mju_mulMatVec3(frame.place.data(), outer.turned.data(), inner.place.data());
  mju_addTo3(frame.place.data(), outer.place.data());
  frame.turned = times(outer.turned, inner.turned);
  return frame;
}

/// About the origin of a frame, which adds up.
struct Weight {
  mjtNum mass{0};
  Numbers3 first{};
  Matrix second{};

  /// Of a mass somewhere, with an inertia about that place.
  void add(mjtNum more, const Numbers3& at, const Matrix& inertia, mjtNum sign = 1) {
    const mjtNum squared = mju_dot3(at.data(), at.data());
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column)
        second[3 * row + column] +=
            inertia[3 * row + column] + sign * more * ((row == column ? squared : 0) - at[row] * at[column]);
  }
};

/// Ixx Ixy Ixz Ixy ...
[[nodiscard]] Matrix inertia_of(const Element& inertial) {
  const Element* inertia = child_of(inertial, "inertia");
  const mjtNum xy = one(inertia, "ixy"), xz = one(inertia, "ixz"), yz = one(inertia, "iyz");
  return {one(inertia, "ixx"), xy, xz, xy, one(inertia, "iyy"), yz, xz, yz, one(inertia, "izz")};
}

[[nodiscard]] bool may_be(const Matrix& inertia) {
  if (std::ranges::all_of(inertia, [](mjtNum number) { return number == 0; })) return true;
  Numbers3 moments{};
  std::array<mjtNum, 4> quaternion{};
  Matrix axes{};
  mju_eig3(moments.data(), axes.data(), quaternion.data(), inertia.data());
  const mjtNum largest = *std::ranges::max_element(moments);
  return *std::ranges::min_element(moments) >= mjMINVAL &&
         largest <= (moments[0] + moments[1] + moments[2] - largest) * (1 + rounding);
}

void add(const Element& inertial, const Frame& link, Weight& all) {
  const Frame frame = within(link, frame_of(inertial));
  const mjtNum mass = one(child_of(inertial, "mass"), "value");
  Matrix back{};
  mju_transpose(back.data(), frame.turned.data(), 3, 3);
  all.add(mass, frame.place, times(times(frame.turned, inertia_of(inertial)), back));
  all.mass += mass;
  mju_addToScl3(all.first.data(), frame.place.data(), mass);
}

[[nodiscard]] Element element(std::string name, std::vector<std::pair<const char*, std::string>> said) {
  Element made;
  made.name = std::move(name);
  for (auto& [attribute, value] : said)
    made.attributes.push_back({.name = attribute, .value = std::move(value), .at = {}, .value_at = {}});
  return made;
}

[[nodiscard]] Element inertial_of(Weight all) {
  Numbers3 centre{};
  if (all.mass > 0) mju_scl3(centre.data(), all.first.data(), 1 / all.mass);
  all.add(all.mass, centre, {}, -1);
  const auto number = [](mjtNum value) { return fmt::format("{:.17g}", value); };
  Element inertial = element("inertial", {});
  inertial.children = {
      element("origin", {{"xyz", fmt::format("{:.17g} {:.17g} {:.17g}", centre[0], centre[1], centre[2])}}),
      element("mass", {{"value", number(all.mass)}}),
      element("inertia", {{"ixx", number(all.second[0])},
                          {"ixy", number(all.second[1])},
                          {"ixz", number(all.second[2])},
                          {"iyy", number(all.second[4])},
                          {"iyz", number(all.second[5])},
                          {"izz", number(all.second[8])}})};
  return inertial;
}

/// Who carries a link that is fixed to it, and where.
struct Fixed {
  std::string carrier;
  Frame frame;
};

/// Which links are one body, however they are written.
class RigidBodies {
 public:
  explicit RigidBodies(Element& robot) {
    for (const Element& joint : robot.children)
      if (joint.name == "joint" && said(&joint, "type") == "fixed")
        fixed_[said(child_of(joint, "child"), "link")] = {said(child_of(joint, "parent"), "link"), frame_of(joint)};
    for (Element& link : robot.children)
      if (link.name == "link") bodies_[carried(said(&link, "name")).carrier].push_back(&link);
  }
  /// By the one that carries all others, which carries itself.
  [[nodiscard]] const std::map<std::string, std::vector<Element*>>& all() const { return bodies_; }
  [[nodiscard]] Fixed carried(std::string link) const {
    Frame frame;
    // No circle of joints is longer than there are joints.
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
      const auto found = fixed_.find(link);
      if (found == fixed_.end()) break;
      frame = within(found->second.frame, frame);
      link = found->second.carrier;
    }
    return Fixed{link, frame};
  }

 private:
  std::map<std::string, Fixed> fixed_;
  std::map<std::string, std::vector<Element*>> bodies_;
};

[[nodiscard]] bool has_moments(const Element* link) {
  const Element* inertial = child_of(*link, "inertial");
  return inertial != nullptr && std::ranges::any_of(inertia_of(*inertial), [](mjtNum number) { return number != 0; });
}

/// Next to nothing more than it has: a point's mass stays what and where it is.
void fill(Element& link) {
  const auto found = std::ranges::find(link.children, "inertial", &Element::name);
  Element inertial = element("inertial", {});
  if (found != link.children.end()) {
    inertial = std::move(*found);
    link.children.erase(found);
  }
  const mjtNum mass = std::max(one(child_of(inertial, "mass"), "value"), next_to_no_mass);
  std::erase_if(inertial.children,
                [](const Element& child) { return child.name == "mass" || child.name == "inertia"; });
  const std::string moment = fmt::format("{:.17g}", next_to_no_moment);
  inertial.children.push_back(element("mass", {{"value", fmt::format("{:.17g}", mass)}}));
  inertial.children.push_back(element(
      "inertia", {{"ixx", moment}, {"ixy", "0"}, {"ixz", "0"}, {"iyy", moment}, {"iyz", "0"}, {"izz", moment}}));
  link.children.push_back(std::move(inertial));
}

}  // namespace

void fill_links_between(Element& robot) {
  const RigidBodies bodies{robot};
  std::set<std::string> moved, moving;
  for (const Element& joint : robot.children) {
    if (joint.name != "joint" || said(&joint, "type") == "fixed") continue;
    moved.insert(said(child_of(joint, "child"), "link"));
    moving.insert(bodies.carried(said(child_of(joint, "parent"), "link")).carrier);
  }
  for (const auto& [carrier, links] : bodies.all()) {
    if (!moved.contains(carrier) || !moving.contains(carrier) || std::ranges::any_of(links, has_moments)) continue;
    for (Element* link : links)
      if (said(link, "name") == carrier) fill(*link);
  }
}

void join_impossible_links(Element& robot) {
  const RigidBodies bodies{robot};
  for (const auto& [carrier, links] : bodies.all()) {
    const auto impossible = [](const Element* link) {
      const Element* inertial = child_of(*link, "inertial");
      return inertial != nullptr && !may_be(inertia_of(*inertial));
    };
    if (links.size() < 2 || std::ranges::none_of(links, impossible)) continue;
    Weight all;
    for (Element* link : links) {
      if (const Element* inertial = child_of(*link, "inertial"))
        add(*inertial, bodies.carried(said(link, "name")).frame, all);
      std::erase_if(link->children, [](const Element& child) { return child.name == "inertial"; });
    }
    for (Element* link : links)
      if (said(link, "name") == carrier) link->children.push_back(inertial_of(all));
  }
}

}  // namespace hirosco::simulation
