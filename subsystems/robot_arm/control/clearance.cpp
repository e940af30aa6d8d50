// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/clearance.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "hirosco/xml/reader.hpp"

namespace hirosco::robot_arm {
namespace {

using xml::Element;

[[nodiscard]] const Element* child(const Element& element, std::string_view name) {
  const auto found = std::ranges::find(element.children, name, &Element::name);
  return found != element.children.end() ? &*found : nullptr;
}

/// Numbers of an attribute, 0 where there are none: the strict reader has seen the file before.
[[nodiscard]] std::array<double, 3> numbers(const Element* element, std::string_view attribute) {
  std::array<double, 3> found{};
  const auto* text = element != nullptr ? element->find(attribute) : nullptr;
  if (text == nullptr) return found;
  const char* at = text->value.data();
  const char* const end = at + text->value.size();
  for (double& number : found) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '+')) ++at;
    at = std::from_chars(at, end, number).ptr;
  }
  return found;
}

[[nodiscard]] std::optional<Capsule> enclosing(const Element& geometry) {
  if (const Element* sphere = child(geometry, "sphere"))
    return Capsule{Vector3::Zero(), Vector3::Zero(), numbers(sphere, "radius")[0]};
  if (const Element* cylinder = child(geometry, "cylinder")) {
    const Vector3 half{0, 0, numbers(cylinder, "length")[0] / 2};
    return Capsule{-half, half, numbers(cylinder, "radius")[0]};
  }
  if (const Element* box = child(geometry, "box")) {
    const auto sides = numbers(box, "size");
    const auto longest = static_cast<std::size_t>(std::ranges::max_element(sides) - sides.begin());
    Vector3 half = Vector3::Zero();
    half[static_cast<Eigen::Index>(longest)] = sides[longest] / 2;
    const double a = sides[(longest + 1) % 3], b = sides[(longest + 2) % 3];
    return Capsule{-half, half, std::sqrt(a * a + b * b) / 2};
  }
  return std::nullopt;
}

[[nodiscard]] Capsule moved(const robotics::Pose& pose, const Capsule& capsule) noexcept {
  return {pose * capsule.from, pose * capsule.to, capsule.radius_m};
}

[[nodiscard]] robotics::Pose origin_of(const Element& element) {
  const Element* origin = child(element, "origin");
  const auto xyz = numbers(origin, "xyz"), rpy = numbers(origin, "rpy");
  using Eigen::AngleAxisd;
  return {(AngleAxisd{rpy[2], Vector3::UnitZ()} * AngleAxisd{rpy[1], Vector3::UnitY()} *
           AngleAxisd{rpy[0], Vector3::UnitX()})
              .toRotationMatrix(),
          {xyz[0], xyz[1], xyz[2]}};
}

}  // namespace

/// Of two line segments: the nearest points of both lines, brought back to the segments one after the other.
double distance_m(const Capsule& one, const Capsule& other) noexcept {
  constexpr double tiny = 1e-12;
  const Vector3 u = one.to - one.from, v = other.to - other.from, w = one.from - other.from;
  const double a = u.dot(u), e = v.dot(v), f = v.dot(w);
  double s = 0, t = 0;
  if (a <= tiny) {
    t = e <= tiny ? 0 : std::clamp(f / e, 0.0, 1.0);
  } else {
    const double c = u.dot(w);
    if (e <= tiny) {
      s = std::clamp(-c / a, 0.0, 1.0);
    } else {
      const double b = u.dot(v), scale = a * e - b * b;
      s = scale > tiny * a * e ? std::clamp((b * f - c * e) / scale, 0.0, 1.0) : 0;
      t = (b * s + f) / e;
      if (t < 0 || t > 1) {
        t = std::clamp(t, 0.0, 1.0);
        s = std::clamp((b * t - c) / a, 0.0, 1.0);
      }
    }
  }
  return (w + s * u - t * v).norm() - one.radius_m - other.radius_m;
}

Hulls hulls_of(std::string_view urdf) {
  Hulls found;
  const auto tree = xml::read_tree(urdf);
  if (!tree) return found;
  for (const Element& link : tree->children) {
    const auto* name = link.name == "link" ? link.find("name") : nullptr;
    if (name == nullptr) continue;
    for (const Element& shape : link.children) {
      if (shape.name != "collision") continue;
      const Element* geometry = child(shape, "geometry");
      const auto capsule = geometry != nullptr ? enclosing(*geometry) : std::nullopt;
      if (capsule) found.hulls.push_back({name->value, moved(origin_of(shape), *capsule)});
      else found.unknown.push_back(name->value);
    }
  }
  return found;
}

Clearance::Clearance(const robotics::Model& model, const Hulls& hulls, double margin_m)
    : dynamics_{model, robotics::Base::Fixed} {
  std::vector<std::size_t> bodies;
  for (const Hull& hull : hulls.hulls) {
    const auto frame = model.find_frame(hull.link);
    if (!frame) continue;
    bodies.push_back(model.frame(*frame).body);
    parts_.push_back({*frame, hull.capsule, {}, bodies.back() != 0, hull.link + " and a volume to keep out of"});
  }
  state_.qd = JointVector::Zero(model.joint_count());
  place(JointVector::Zero(model.joint_count()));
  const auto joined = [&](std::size_t one, std::size_t other) {
    return one == other || model.bodies()[one].parent == other || model.bodies()[other].parent == one;
  };
  for (std::size_t i = 0; i < parts_.size(); ++i)
    for (std::size_t j = i + 1; j < parts_.size(); ++j) {
      if (joined(bodies[i], bodies[j]) || distance_m(parts_[i].now, parts_[j].now) < margin_m) continue;
      pairs_.push_back({i, j, model.frame(parts_[i].frame).name + " and " + model.frame(parts_[j].frame).name});
    }
}

void Clearance::keep_out(std::span<const Capsule> volumes) noexcept {
  volumes_ = {};
  std::ranges::copy(volumes.first(std::min(volumes.size(), most_volumes)), volumes_.begin());
}

void Clearance::place(const JointVector& position) noexcept {
  state_.q = position;
  dynamics_.update(state_);
  for (Part& part : parts_) part.now = moved(dynamics_.frame_pose(part.frame), part.own);
}

Clearance::Nearest Clearance::nearest(const JointVector& position) noexcept {
  place(position);
  Nearest found;
  const auto look = [&](double distance, const std::string& names) {
    if (distance < found.distance_m) found = {distance, names.c_str()};
  };
  for (const Pair& pair : pairs_) look(distance_m(parts_[pair.one].now, parts_[pair.other].now), pair.names);
  for (const Capsule& volume : volumes_) {
    if (!(volume.radius_m > 0)) continue;
    for (const Part& part : parts_)
      if (part.moves) look(distance_m(part.now, volume), part.volume);
  }
  return found;
}

}  // namespace hirosco::robot_arm
