// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/mesh.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <utility>

#include "robotics/shapes/mesh_text.hpp"

namespace hirosco::robotics {
namespace detail {
namespace {

/// 80 octets of anything, how many triangles, then each: its normal, three points, two octets of anything.
constexpr std::size_t stl_head_octets = 84, stl_triangle_octets = 50, stl_normal_octets = 12;
/// A text has no octet that is 0 among its first ones.
constexpr std::size_t stl_text_octets = 512;

[[nodiscard]] std::uint32_t word_at(std::string_view octets, std::size_t at) noexcept {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i > 0; --i) word = word << 8 | static_cast<unsigned char>(octets[at + i - 1]);
  return word;
}
void put_word(std::uint32_t word, std::string& octets) {
  for (unsigned shift = 0; shift < 32; shift += 8) octets += static_cast<char>(word >> shift & 0xFFU);
}
void put_point(const Vector3& point, std::string& octets) {
  for (const double number : point) put_word(std::bit_cast<std::uint32_t>(static_cast<float>(number)), octets);
}

[[nodiscard]] std::expected<Mesh, MeshProblem> read_binary_stl(std::string_view octets) {
  const std::size_t triangles = word_at(octets, stl_head_octets - 4);
  Mesh mesh;
  mesh.points.reserve(3 * triangles);
  for (std::size_t i = 0; i < triangles; ++i) {
    const std::size_t at = stl_head_octets + i * stl_triangle_octets + stl_normal_octets;
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (std::size_t k = 0; k < 9; k += 3) {
      Vector3 point;
      for (std::size_t axis = 0; axis < 3; ++axis)
        point[static_cast<Eigen::Index>(axis)] = std::bit_cast<float>(word_at(octets, at + 4 * (k + axis)));
      if (!point.allFinite()) return problem({}, "triangle " + std::to_string(i + 1) + " has a point that is no place");
      mesh.points.push_back(point);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

[[nodiscard]] std::expected<Vector3, MeshProblem> point_of(Words& words, Words::Over over) {
  Vector3 point;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::string_view word = words.next(over);
    const auto number = number_of(word);
    if (!number)
      return problem(words.where(), word.empty() ? "a point has three numbers" : quoted(word) + " is no number");
    point[axis] = *number;
  }
  return point;
}

/// solid NAME, facets, endsolid; of a facet its three points count.
[[nodiscard]] std::expected<Mesh, MeshProblem> read_text_stl(std::string_view octets) {
  Words words{octets};
  Mesh mesh;
  std::size_t in_facet = 3;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "solid" || word == "endsolid" || word == "outer" || word == "endloop") {
      words.pass_line();
    } else if (word == "facet" || word == "endfacet") {
      if (in_facet % 3 != 0) return problem(words.where(), "a facet has three points");
      words.pass_line();
    } else if (word == "vertex") {
      auto point = point_of(words, Words::Over::Line);
      if (!point) return std::unexpected{std::move(point.error())};
      mesh.points.push_back(*point);
      ++in_facet;
      if (const auto count = static_cast<std::uint32_t>(mesh.points.size()); count % 3 == 0)
        mesh.triangles.push_back({count - 3, count - 2, count - 1});
    } else {
      return problem(words.where(), quoted(word) + " is no word of an STL file");
    }
  }
  if (mesh.points.size() % 3 != 0) return problem(words.where(), "its last facet is not whole");
  return mesh;
}

}  // namespace

std::expected<Mesh, MeshProblem> read_stl(std::string_view octets) {
  if (is_binary_stl(octets)) return read_binary_stl(octets);
  if (octets.starts_with("solid") && octets.substr(0, stl_text_octets).find('\0') == std::string_view::npos)
    return read_text_stl(octets);
  if (octets.size() < stl_head_octets) return problem({}, "it is shorter than the head of an STL file");
  const std::uint64_t said = word_at(octets, stl_head_octets - 4);
  return problem({}, "it says that it has " + std::to_string(said) + " triangles, which takes " +
                         std::to_string(stl_head_octets + said * stl_triangle_octets) + " octets, and has " +
                         std::to_string(octets.size()));
}

/// Points and faces; polygons are taken as fans of triangles, indices below 0 count from the last point back.
std::expected<Mesh, MeshProblem> read_obj(std::string_view text) {
  Words words{text};
  Mesh mesh;
  while (!words.at_end()) {
    const std::string_view kind = words.next();
    if (kind == "v") {
      auto point = point_of(words, Words::Over::Line);
      if (!point) return std::unexpected{std::move(point.error())};
      mesh.points.push_back(*point);
    } else if (kind == "f") {
      const auto face_at = words.where();
      std::array<std::uint32_t, 2> before{};
      std::size_t corners = 0;
      for (std::string_view word = words.next(Words::Over::Line); !word.empty();
           word = words.next(Words::Over::Line), ++corners) {
        const auto index = whole_number_of(word.substr(0, word.find('/')));
        const auto points = static_cast<std::int64_t>(mesh.points.size());
        const std::int64_t at = !index ? -1 : *index > 0 ? *index - 1 : points + *index;
        if (!index || *index == 0 || at < 0 || at >= points)
          return problem(words.where(), quoted(word) + " names no point before it");
        const auto point = static_cast<std::uint32_t>(at);
        if (corners >= 2) mesh.triangles.push_back({before[0], before[1], point});
        before[corners == 0 ? 0 : 1] = point;
      }
      if (corners < 3) return problem(face_at, "a face has at least three points");
    }
    words.pass_line();
  }
  return mesh;
}

}  // namespace detail

std::expected<MeshKind, std::string> mesh_kind(std::string_view file) {
  std::string ending{file.substr(file.size() - std::min<std::size_t>(4, file.size()))};
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".stl") return MeshKind::Stl;
  if (ending == ".obj") return MeshKind::Obj;
  if (ending == ".dae") return MeshKind::Collada;
  return std::unexpected{"it is neither STL, OBJ nor COLLADA (.dae)"};
}

std::expected<Mesh, MeshProblem> read_mesh(MeshKind kind, std::string_view octets) {
  auto mesh = kind == MeshKind::Stl   ? detail::read_stl(octets)
              : kind == MeshKind::Obj ? detail::read_obj(octets)
                                      : detail::read_collada(octets);
  if (!mesh) return mesh;
  if (mesh->triangles.empty()) return detail::problem({}, "it has no triangle");
  if (mesh->points.size() > most_mesh_points || mesh->triangles.size() > most_mesh_points)
    return detail::problem({}, "it has more than a million points or triangles");
  for (const Vector3& point : mesh->points)
    if (!(point.cwiseAbs().maxCoeff() <= largest_mesh_m))
      return detail::problem({}, "a point of it is farther than 10 km from its origin: are its units right?");
  return mesh;
}

bool is_binary_stl(std::string_view octets) noexcept {
  if (octets.size() < detail::stl_head_octets) return false;
  const std::uint64_t said = detail::word_at(octets, detail::stl_head_octets - 4);
  return octets.size() == detail::stl_head_octets + said * detail::stl_triangle_octets;
}

std::string as_binary_stl(const Mesh& mesh) {
  // Whoever asks a file's first word whether it is a text must not find that of one there.
  std::string octets = "binary STL, m";
  octets.resize(detail::stl_head_octets - 4, ' ');
  octets.reserve(detail::stl_head_octets + mesh.triangles.size() * detail::stl_triangle_octets);
  detail::put_word(static_cast<std::uint32_t>(mesh.triangles.size()), octets);
  for (const Mesh::Triangle& triangle : mesh.triangles) {
    const Vector3& first = mesh.points[triangle[0]];
    const Vector3 across = (mesh.points[triangle[1]] - first).cross(mesh.points[triangle[2]] - first);
    // A triangle without area has none: 0 says so.
    detail::put_point(across.norm() > 0 ? across.normalized() : across, octets);
    for (const std::uint32_t corner : triangle) detail::put_point(mesh.points[corner], octets);
    octets.append(2, '\0');
  }
  return octets;
}

}  // namespace hirosco::robotics
