// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/collision.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "hirosco/descriptor/model/mesh_files.hpp"
#include "hirosco/xml/reader.hpp"
#include "robotics/shapes/mesh_text.hpp"

namespace hirosco::robotics {
namespace {

using descriptor::Location;
using xml::Element;

/// A cylinder is a prism around it: 2 % wider at its edges.
constexpr std::size_t sides = 16;

[[nodiscard]] Location place(xml::Position at) { return {at.line, at.column}; }

[[nodiscard]] const Element* child(const Element& element, std::string_view name) {
  const auto found = std::ranges::find(element.children, name, &Element::name);
  return found != element.children.end() ? &*found : nullptr;
}

[[nodiscard]] std::vector<Vector3> box_corners(const Vector3& size) {
  std::vector<Vector3> corners;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5}) corners.emplace_back(x * size.x(), y * size.y(), z * size.z());
  return corners;
}

[[nodiscard]] std::vector<Vector3> cylinder_corners(double radius_m, double length_m) {
  std::vector<Vector3> corners;
  const double out_m = radius_m / std::cos(std::numbers::pi / sides);
  for (std::size_t i = 0; i < sides; ++i) {
    const double around = 2 * std::numbers::pi * static_cast<double>(i) / sides;
    for (const double end : {-length_m / 2, length_m / 2})
      corners.emplace_back(out_m * std::cos(around), out_m * std::sin(around), end);
  }
  return corners;
}

[[nodiscard]] RoundedHull moved(const Pose& pose, const RoundedHull& hull) {
  RoundedHull there;
  for (std::size_t i = 0; i < hull.corners(); ++i) static_cast<void>(there.add(pose * hull.corner(i)));
  there.round(hull.radius_m());
  return there;
}

class ShapeReader {
 public:
  ShapeReader(const std::filesystem::path& file, const descriptor::FileSource& source, const Fineness& fineness)
      : file_{file}, source_{source}, fineness_{fineness} {}

  descriptor::Reading<CollisionShapes> read(std::string_view text) && {
    const auto tree = xml::read_tree(text);
    if (!tree) error(place(tree.error().at), "U0002", tree.error().reason, "only plain XML in UTF-8 is read");
    else
      for (const Element& link : tree->children)
        if (link.name == "link")
          for (const Element& collision : link.children)
            if (collision.name == "collision") read_shape(link, collision);
    if (reading_.problems.empty()) reading_.value = std::move(shapes_);
    return std::move(reading_);
  }

 private:
  void read_shape(const Element& link, const Element& collision) {
    const auto* named = link.find("name");
    link_ = named != nullptr ? named->value : std::string{};
    Pose pose;
    if (const Element* origin = child(collision, "origin")) {
      const auto xyz = numbers<3>(*origin, "xyz", 0.0), rpy = numbers<3>(*origin, "rpy", 0.0);
      if (!xyz || !rpy) return;
      using Eigen::AngleAxisd;
      pose = {(AngleAxisd{(*rpy)[2], Vector3::UnitZ()} * AngleAxisd{(*rpy)[1], Vector3::UnitY()} *
               AngleAxisd{(*rpy)[0], Vector3::UnitX()})
                  .toRotationMatrix(),
              {(*xyz)[0], (*xyz)[1], (*xyz)[2]}};
    }
    const Element* geometry = child(collision, "geometry");
    if (geometry == nullptr || geometry->children.size() != 1)
      return unseen(place(collision.at), "U0703", "has a <collision> without one shape in a <geometry>",
                    "write one <box>, <cylinder>, <sphere> or <mesh>");
    const Element& shape = geometry->children.front();
    if (shape.name == "mesh") return read_mesh_shape(shape, pose);
    if (shape.name == "sphere") {
      if (const auto radius = sizes<1>(shape, "radius"))
        take(pose, RoundedHull{std::array{Vector3{Vector3::Zero()}}, (*radius)[0]});
    } else if (shape.name == "box") {
      if (const auto size = sizes<3>(shape, "size"))
        take(pose, RoundedHull{box_corners({(*size)[0], (*size)[1], (*size)[2]}), 0});
    } else if (shape.name == "cylinder") {
      const auto radius = sizes<1>(shape, "radius"), length = sizes<1>(shape, "length");
      if (radius && length) take(pose, RoundedHull{cylinder_corners((*radius)[0], (*length)[0]), 0});
    } else {
      unseen(place(shape.at), "U0703", "has a shape <" + shape.name + ">, which is not known",
             "box, cylinder, sphere or mesh");
    }
  }

  void read_mesh_shape(const Element& shape, const Pose& pose) {
    const auto scale = numbers<3>(shape, "scale", 1.0);
    const auto* named = shape.find("filename");
    if (!scale) return;
    const auto at = place(named != nullptr ? named->value_at : shape.at);
    const auto beside = descriptor::mesh_beside(named != nullptr ? named->value : std::string{});
    if (!beside)
      return unseen(at, "U0701", "has a mesh that is not beside this file",
                    "name it by a way from this file's folder down, or as package://A/B, which is A/B there");
    const auto kind = mesh_kind(beside->native());
    if (!kind)
      return unseen(at, "U0702", "has a mesh that cannot be read: " + kind.error(),
                    "convert it to STL, or give the link boxes and cylinders");
    const auto path = file_.parent_path() / *beside;
    auto mesh = meshes_.find(path);
    if (mesh == meshes_.end()) {
      const auto octets = source_(path);
      if (!octets)
        return unseen(at, "U0702", "has a mesh that cannot be read: " + beside->string() + " " + octets.error().text,
                      "put it there; of at most 4 MiB");
      auto read = read_mesh(*kind, *octets);
      if (!read) {
        reading_.problems.push_back({path, read.error().at, "U0704",
                                     "the mesh of link '" + link_ + "' is wrong: " + read.error().text,
                                     "export it anew: a link that is not seen as it is would be run into", 1});
        return;
      }
      mesh = meshes_.emplace(path, std::move(*read)).first;
    }
    Mesh scaled = mesh->second;
    for (Vector3& point : scaled.points)
      point = pose * point.cwiseProduct(Vector3{(*scale)[0], (*scale)[1], (*scale)[2]}).eval();
    for (const RoundedHull& hull : enclosing(scaled, fineness_)) shapes_.hulls.push_back({link_, hull});
  }

  void take(const Pose& pose, const RoundedHull& hull) { shapes_.hulls.push_back({link_, moved(pose, hull)}); }

  /// `otherwise` each where the attribute is not there. Nothing: it is wrong, and that is told.
  template <std::size_t count>
  std::optional<std::array<double, count>> numbers(const Element& element, std::string_view name, double otherwise) {
    std::array<double, count> found;
    found.fill(otherwise);
    const auto* attribute = element.find(name);
    if (attribute == nullptr) return found;
    detail::Words words{attribute->value};
    bool good = true;
    for (double& each : found) {
      const auto number = detail::number_of(words.next());
      good = good && number && std::abs(*number) <= largest_mesh_m;
      each = number.value_or(0);
    }
    if (good && words.next().empty()) return found;
    error(place(attribute->value_at), "U0705",
          "'" + std::string{name} + "' of <" + element.name + "> of link '" + link_ + "' is " +
              detail::quoted(attribute->value) + ", not " + std::to_string(count) + " numbers of at most 10000",
          "write decimal numbers without units, with blanks between them");
    return std::nullopt;
  }
  /// Such that must be there, and are at least 0.
  template <std::size_t count>
  std::optional<std::array<double, count>> sizes(const Element& element, std::string_view name) {
    const auto found = numbers<count>(element, name, -1);
    if (!found || std::ranges::min(*found) >= 0) return found;
    error(place(element.at), "U0705",
          "<" + element.name + "> of link '" + link_ + "' lacks '" + std::string{name} + "', or it is negative",
          "write its size in m");
    return std::nullopt;
  }

  void error(Location at, const char* code, std::string message, std::string hint) {
    reading_.problems.push_back({file_, at, code, std::move(message), std::move(hint), 1});
  }
  void unseen(Location at, const char* code, const std::string& what, std::string hint) {
    reading_.warnings.push_back({file_, at, code, "link '" + link_ + "' " + what + ": this shape is not seen",
                                 std::move(hint), 1, descriptor::Grade::Warning});
    if (std::ranges::find(shapes_.unseen, link_) == shapes_.unseen.end()) shapes_.unseen.push_back(link_);
  }

  const std::filesystem::path& file_;
  const descriptor::FileSource& source_;
  const Fineness& fineness_;
  std::string link_;
  std::map<std::filesystem::path, Mesh> meshes_;  ///< several links may have the same
  CollisionShapes shapes_;
  descriptor::Reading<CollisionShapes> reading_;
};

}  // namespace

descriptor::Reading<CollisionShapes> read_collision_shapes(const std::filesystem::path& file, std::string_view text,
                                                           const descriptor::FileSource& source,
                                                           const Fineness& fineness) {
  return ShapeReader{file, source, fineness}.read(text);
}

}  // namespace hirosco::robotics
