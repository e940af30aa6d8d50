// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "hirosco/xml/reader.hpp"
#include "robotics/shapes/mesh_text.hpp"

namespace hirosco::robotics::detail {
namespace {

using xml::Element;
using Placement = Eigen::Affine3d;
using Indices = std::vector<std::uint32_t>;

/// As deep as XML is read; who refers to himself is deeper.
constexpr std::size_t deepest = xml::max_depth;
/// Who shows others twice each shows no end of them.
constexpr std::size_t most_nodes = 10'000;

[[nodiscard]] descriptor::Location place(xml::Position at) { return {at.line, at.column}; }

[[nodiscard]] const Element* child(const Element& element, std::string_view name) {
  const auto found = std::ranges::find(element.children, name, &Element::name);
  return found != element.children.end() ? &*found : nullptr;
}

[[nodiscard]] std::string_view attribute(const Element& element, std::string_view name) {
  const auto* found = element.find(name);
  return found != nullptr ? std::string_view{found->value} : std::string_view{};
}

[[nodiscard]] Words words_of(const Element& element) {
  std::string_view text = element.text;
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t\r\n")));
  return Words{text, place(element.text_at)};
}

[[nodiscard]] std::expected<std::vector<double>, MeshProblem> numbers_of(const Element& element) {
  Words words = words_of(element);
  std::vector<double> numbers;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const auto number = number_of(word);
    if (!number) return problem(words.where(), quoted(word) + " in <" + element.name + "> is no number");
    numbers.push_back(*number);
  }
  return numbers;
}

[[nodiscard]] std::expected<Indices, MeshProblem> indices_of(const Element& element) {
  Words words = words_of(element);
  Indices indices;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const auto number = whole_number_of(word);
    if (!number || *number < 0 || *number > static_cast<std::int64_t>(UINT32_MAX))
      return problem(words.where(), quoted(word) + " in <" + element.name + "> is no index");
    indices.push_back(static_cast<std::uint32_t>(*number));
  }
  return indices;
}

/// What an input of a primitive says: which of the numbers of a corner is that of its point, and how many each corner has.
struct Layout {
  const Element* vertex{nullptr};
  std::size_t offset{0};
  std::size_t stride{1};
};

class Collada {
 public:
  explicit Collada(const Element& root) : root_{root} { know(root); }

  [[nodiscard]] std::expected<Mesh, MeshProblem> read() {
    if (root_.name != "COLLADA") return problem(place(root_.at), "its root element is not <COLLADA>");
    Placement unit = Placement::Identity();
    if (const Element* asset = child(root_, "asset"))
      if (const Element* found = child(*asset, "unit"); found != nullptr && found->find("meter") != nullptr) {
        const auto metres = number_of(attribute(*found, "meter"));
        if (!metres || !(*metres > 0)) return problem(place(found->at), "its unit is no number of metres above 0");
        unit = Eigen::Scaling(*metres);
      }
    std::expected<void, MeshProblem> added;
    if (const Element* scene = shown()) {
      for (const Element& node : scene->children)
        if (added && node.name == "node") added = add_node(node, unit, 0);
    } else if (const Element* library = child(root_, "library_geometries")) {
      for (const Element& geometry : library->children)
        if (added && geometry.name == "geometry") added = add_geometry(geometry, unit);
    }
    if (!added) return std::unexpected{std::move(added.error())};
    return std::move(mesh_);
  }

 private:
  using Added = std::expected<void, MeshProblem>;

  void know(const Element& element) {
    if (const auto id = attribute(element, "id"); !id.empty()) by_id_.emplace(id, &element);
    for (const Element& each : element.children) know(each);
  }
  /// Whom `url` or `source` names.
  [[nodiscard]] std::expected<const Element*, MeshProblem> meant(const Element& element, std::string_view name) const {
    std::string_view id = attribute(element, name);
    if (id.starts_with('#')) id.remove_prefix(1);
    const auto found = by_id_.find(id);
    if (found == by_id_.end())
      return problem(place(element.at), "<" + element.name + "> names " + quoted(id) + ", which is not in this file");
    return found->second;
  }
  [[nodiscard]] const Element* shown() const {
    const Element* scene = child(root_, "scene");
    const Element* instance = scene != nullptr ? child(*scene, "instance_visual_scene") : nullptr;
    if (instance == nullptr) return nullptr;
    const auto found = meant(*instance, "url");
    return found ? *found : nullptr;
  }

  Added add_node(const Element& node, Placement at, std::size_t depth) {
    if (depth > deepest) return problem(place(node.at), "nodes are in each other deeper than 64");
    if (++nodes_ > most_nodes) return problem(place(node.at), "more than 10000 nodes are shown");
    for (const Element& part : node.children) {
      if (auto moved = move(part, at); !moved) return moved;
      Added added;
      if (part.name == "node") {
        added = add_node(part, at, depth + 1);
      } else if (part.name == "instance_node" || part.name == "instance_geometry") {
        const auto whom = meant(part, "url");
        if (!whom) return std::unexpected{whom.error()};
        added = part.name == "instance_node" ? add_node(**whom, at, depth + 1) : add_geometry(**whom, at);
      } else if (part.name == "instance_controller") {
        return problem(place(part.at), "<instance_controller> is not read: export it without a skin");
      }
      if (!added) return added;
    }
    return {};
  }

  [[nodiscard]] static Added move(const Element& part, Placement& at) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 4> kinds{
        {{"matrix", 16}, {"translate", 3}, {"rotate", 4}, {"scale", 3}}};
    if (part.name == "lookat" || part.name == "skew")
      return problem(place(part.at), "<" + part.name + "> is not read: write it as <matrix>");
    const auto kind = std::ranges::find(kinds, part.name, &std::pair<std::string_view, std::size_t>::first);
    if (kind == kinds.end()) return {};
    const auto numbers = numbers_of(part);
    if (!numbers) return std::unexpected{numbers.error()};
    if (numbers->size() != kind->second)
      return problem(place(part.at), "<" + part.name + "> has " + std::to_string(kind->second) + " numbers");
    const std::vector<double>& its = *numbers;
    if (part.name == "matrix")
      at = at * Placement{Eigen::Matrix<double, 4, 4, Eigen::RowMajor>{its.data()}.topRows<3>().eval()};
    else if (part.name == "translate") at = at * Eigen::Translation3d{its[0], its[1], its[2]};
    else if (part.name == "scale") at = at * Eigen::Scaling(its[0], its[1], its[2]);
    else if (const Vector3 axis{its[0], its[1], its[2]}; axis.norm() > 0)
      at = at * Eigen::AngleAxisd{its[3] / 180 * std::numbers::pi, axis.normalized()};
    return {};
  }

  Added add_geometry(const Element& geometry, const Placement& at) {
    const Element* mesh = child(geometry, "mesh");
    if (mesh == nullptr) return problem(place(geometry.at), "<" + geometry.name + "> has no <mesh>");
    for (const Element& primitive : mesh->children) {
      if (primitive.name != "triangles" && primitive.name != "polylist" && primitive.name != "polygons" &&
          primitive.name != "tristrips" && primitive.name != "trifans")
        continue;
      const auto layout = layout_of(primitive);
      if (!layout) return std::unexpected{layout.error()};
      const auto first = static_cast<std::uint32_t>(mesh_.points.size());
      if (auto added = add_points(*layout->vertex, at); !added) return added;
      const std::size_t first_triangle = mesh_.triangles.size();
      if (auto added = add_faces(primitive, *layout, first); !added) return added;
      // A place that mirrors would turn its surface inside out.
      if (at.linear().determinant() < 0)
        for (Mesh::Triangle& triangle : std::span{mesh_.triangles}.subspan(first_triangle))
          std::swap(triangle[1], triangle[2]);
    }
    return {};
  }

  [[nodiscard]] static std::expected<Layout, MeshProblem> layout_of(const Element& primitive) {
    Layout layout;
    for (const Element& input : primitive.children) {
      if (input.name != "input") continue;
      const auto offset = whole_number_of(attribute(input, "offset")).value_or(-1);
      if (offset < 0 || offset > 64) return problem(place(input.at), "<input> has no offset from 0 to 64");
      layout.stride = std::max(layout.stride, static_cast<std::size_t>(offset) + 1);
      if (attribute(input, "semantic") != "VERTEX") continue;
      layout.vertex = &input;
      layout.offset = static_cast<std::size_t>(offset);
    }
    if (layout.vertex == nullptr) return problem(place(primitive.at), "<" + primitive.name + "> has no input VERTEX");
    return layout;
  }

  /// Whoever the input names: <vertices>, whose POSITION is a <source>.
  Added add_points(const Element& vertex, const Placement& at) {
    const auto vertices = meant(vertex, "source");
    if (!vertices) return std::unexpected{vertices.error()};
    for (const Element& input : (*vertices)->children) {
      if (input.name != "input" || attribute(input, "semantic") != "POSITION") continue;
      const auto source = meant(input, "source");
      if (!source) return std::unexpected{source.error()};
      const Element* array = child(**source, "float_array");
      const Element* common = child(**source, "technique_common");
      const Element* accessor = common != nullptr ? child(*common, "accessor") : nullptr;
      if (array == nullptr) return problem(place((*source)->at), "<source> has no <float_array>");
      const auto numbers = numbers_of(*array);
      if (!numbers) return std::unexpected{numbers.error()};
      const auto said = [&](std::string_view name, std::int64_t otherwise) {
        return accessor != nullptr && accessor->find(name) != nullptr
                   ? whole_number_of(attribute(*accessor, name)).value_or(-1)
                   : otherwise;
      };
      const std::int64_t stride = said("stride", 3), offset = said("offset", 0);
      if (stride < 3 || stride > 64 || offset < 0 || offset > static_cast<std::int64_t>(numbers->size()))
        return problem(place(accessor->at), "its <accessor> gives no points of three numbers");
      for (auto i = static_cast<std::size_t>(offset); i + 3 <= numbers->size(); i += static_cast<std::size_t>(stride))
        mesh_.points.push_back(at * Vector3{(*numbers)[i], (*numbers)[i + 1], (*numbers)[i + 2]});
      if (mesh_.points.size() > most_mesh_points)
        return problem(place((*source)->at), "it has more than a million points");
      return {};
    }
    return problem(place((*vertices)->at), "<" + (*vertices)->name + "> has no input POSITION");
  }

  Added add_faces(const Element& primitive, const Layout& layout, std::uint32_t first) {
    Indices counts;
    if (primitive.name == "polylist") {
      const Element* vcount = child(primitive, "vcount");
      if (vcount == nullptr) return problem(place(primitive.at), "<polylist> has no <vcount>");
      auto read = indices_of(*vcount);
      if (!read) return std::unexpected{read.error()};
      counts = std::move(*read);
    }
    for (const Element& p : primitive.children) {
      if (p.name == "ph") return problem(place(p.at), "a polygon with holes is not read: export it as triangles");
      if (p.name != "p") continue;
      const auto numbers = indices_of(p);
      if (!numbers) return std::unexpected{numbers.error()};
      Indices corners;
      for (std::size_t i = layout.offset; i < numbers->size(); i += layout.stride) {
        if ((*numbers)[i] >= mesh_.points.size() - first)
          return problem(place(p.text_at), "a corner of <p> is point " + std::to_string((*numbers)[i]) +
                                               ", and there are " + std::to_string(mesh_.points.size() - first));
        corners.push_back(first + (*numbers)[i]);
      }
      if (auto added = add_polygons(primitive, counts, corners); !added) return added;
      if (mesh_.triangles.size() > most_mesh_points)
        return problem(place(p.at), "it has more than a million triangles");
    }
    return {};
  }

  Added add_polygons(const Element& primitive, const Indices& counts, const Indices& corners) {
    const auto fan = [&](std::size_t from, std::size_t count) {
      for (std::size_t i = from + 2; i < from + count; ++i)
        mesh_.triangles.push_back({corners[from], corners[i - 1], corners[i]});
    };
    if (primitive.name == "triangles") {
      for (std::size_t i = 0; i + 3 <= corners.size(); i += 3) fan(i, 3);
    } else if (primitive.name == "tristrips") {
      // Every second one of a strip goes round the other way.
      for (std::size_t i = 0; i + 3 <= corners.size(); ++i) {
        fan(i, 3);
        if (i % 2 != 0) std::swap(mesh_.triangles.back()[1], mesh_.triangles.back()[2]);
      }
    } else if (primitive.name != "polylist") {
      fan(0, corners.size());
    } else {
      std::size_t at = 0;
      for (const std::uint32_t count : counts) {
        if (count > corners.size() - at) return problem(place(primitive.at), "<p> is shorter than <vcount> says");
        fan(at, count);
        at += count;
      }
    }
    return {};
  }

  const Element& root_;
  std::map<std::string_view, const Element*> by_id_;
  Mesh mesh_;
  std::size_t nodes_{0};
};

}  // namespace

std::expected<Mesh, MeshProblem> read_collada(std::string_view text) {
  const auto tree = xml::read_tree(text);
  if (!tree) return problem(place(tree.error().at), tree.error().reason);
  return Collada{*tree}.read();
}

}  // namespace hirosco::robotics::detail
