// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mesh_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace hirosco::simulation {
namespace {

/// Directions are all those of whole numbers up to this.
constexpr int farthest_direction = 2;

/// Facets, and where they are longest along an axis.
struct PartOfMesh {
  std::vector<Facet> facets;
  std::size_t axis{0};
  double longest_m{0};
  double middle_m{0};
};

[[nodiscard]] PartOfMesh measured(std::vector<Facet> facets) {
  PartOfMesh part{.facets = std::move(facets)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Facet& facet : part.facets)
      for (const Corner& corner : facet) {
        low = std::min(low, corner[axis]);
        high = std::max(high, corner[axis]);
      }
    if (!(high - low > part.longest_m)) continue;
    part.axis = axis;
    part.longest_m = high - low;
    part.middle_m = low + (high - low) / 2;
  }
  return part;
}

/// What of a facet is on one side of a plane across `axis`: none to two facets. `side`: -1 below it, 1 above.
void take_side(const Facet& facet, std::size_t axis, double plane_m, double side, std::vector<Facet>& taken) {
  std::array<Corner, 4> polygon{};
  std::size_t corners = 0;
  for (std::size_t i = 0; i < facet.size(); ++i) {
    const Corner& here = facet[i];
    const Corner& next = facet[(i + 1) % facet.size()];
    const double here_m = side * (here[axis] - plane_m), next_m = side * (next[axis] - plane_m);
    if (here_m >= 0) polygon[corners++] = here;
    if ((here_m < 0) == (next_m < 0) || here_m == 0 || next_m == 0) continue;
    Corner& between = polygon[corners++];
    for (std::size_t k = 0; k < 3; ++k) between[k] = here[k] + (next[k] - here[k]) * (here_m / (here_m - next_m));
    between[axis] = plane_m;  // without the rounding of the line above: whoever is in the plane is so for both sides
  }
  for (std::size_t i = 2; i < corners; ++i) taken.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

/// All of whole numbers that are no multiples of each other.
[[nodiscard]] std::vector<Corner> directions() {
  std::vector<Corner> found;
  for (int x = -farthest_direction; x <= farthest_direction; ++x)
    for (int y = -farthest_direction; y <= farthest_direction; ++y)
      for (int z = -farthest_direction; z <= farthest_direction; ++z)
        if (std::gcd(std::gcd(x, y), z) == 1)
          found.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  return found;
}

/// In order.
[[nodiscard]] MeshPiece each_once(MeshPiece all) {
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

[[nodiscard]] MeshPiece corners_of(const std::vector<Facet>& facets) {
  MeshPiece corners;
  corners.reserve(3 * facets.size());
  for (const Facet& facet : facets) corners.insert(corners.end(), facet.begin(), facet.end());
  return each_once(std::move(corners));
}

[[nodiscard]] MeshPiece farthest_of(const std::vector<Facet>& facets) {
  const MeshPiece corners = corners_of(facets);
  MeshPiece piece;
  for (const Corner& direction : directions())
    piece.push_back(*std::ranges::max_element(corners, {}, [&](const Corner& corner) {
      return corner[0] * direction[0] + corner[1] * direction[1] + corner[2] * direction[2];
    }));
  return each_once(std::move(piece));
}

/// Each edge of each facet is one of another facet in the other direction, so a hull fills nothing that is open.
[[nodiscard]] bool is_closed(const std::vector<Facet>& facets) {
  const MeshPiece corners = corners_of(facets);
  const auto number_of = [&](const Corner& corner) {
    return std::ranges::lower_bound(corners, corner) - corners.begin();
  };
  using Edge = std::pair<std::ptrdiff_t, std::ptrdiff_t>;
  std::vector<Edge> there, back;
  for (const Facet& facet : facets)
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::ptrdiff_t from = number_of(facet[i]), to = number_of(facet[(i + 1) % facet.size()]);
      there.emplace_back(from, to);
      back.emplace_back(to, from);
    }
  std::ranges::sort(there);
  std::ranges::sort(back);
  return there == back;
}

/// Of a facet, as long as twice its area.
[[nodiscard]] Corner normal_of(const Facet& facet) {
  Corner along{}, across{};
  for (std::size_t k = 0; k < 3; ++k) {
    along[k] = facet[1][k] - facet[0][k];
    across[k] = facet[2][k] - facet[0][k];
  }
  return {along[1] * across[2] - along[2] * across[1], along[2] * across[0] - along[0] * across[2],
          along[0] * across[1] - along[1] * across[0]};
}

/// How far `to` is from `from` along `normal`, times the length of that.
[[nodiscard]] double along_normal(const Corner& normal, const Corner& from, const Corner& to) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += normal[k] * (to[k] - from[k]);
  return sum;
}

/// Whichever side of its facets a file has outside.
[[nodiscard]] bool is_convex(const std::vector<Facet>& facets, const MeshPiece& corners) {
  return std::ranges::all_of(facets, [&](const Facet& facet) {
    const Corner normal = normal_of(facet);
    const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    double front = 0, behind = 0;
    for (const Corner& corner : corners) {
      const double above = along_normal(normal, facet[0], corner);
      front = std::max(front, above);
      behind = std::max(behind, -above);
    }
    return std::min(front, behind) <= convex_within_m * length;
  });
}

/// From the middle nearly all of it is seen from one side. Walls thinner than convex_within_m lie where their hull does, inside as well as
/// outside, and so do sheets that have two sides: of a cup, a dish or two plates beside each other half is seen from the other side.
[[nodiscard]] bool is_full(const std::vector<Facet>& facets, const MeshPiece& corners) {
  constexpr double least_share = 0.9;
  Corner middle{};
  for (const Corner& corner : corners)
    for (std::size_t k = 0; k < 3; ++k) middle[k] += corner[k] / static_cast<double>(corners.size());
  double enclosed = 0, all = 0;
  for (const Facet& facet : facets) {
    const double above = along_normal(normal_of(facet), middle, facet[0]);
    enclosed += above;
    all += std::abs(above);
  }
  return std::abs(enclosed) >= least_share * all;
}

[[nodiscard]] std::vector<MeshPiece> cut(std::vector<Facet> surface) {
  std::vector<PartOfMesh> parts;
  parts.push_back(measured(std::move(surface)));
  std::size_t facets = parts.front().facets.size();
  while (parts.size() < most_pieces && facets <= most_cut_facets) {
    const auto longest = std::ranges::max_element(parts, {}, &PartOfMesh::longest_m);
    if (longest->longest_m < 2 * shortest_piece_m) break;
    const PartOfMesh whole = std::exchange(*longest, PartOfMesh{});
    std::vector<Facet> below, above;
    for (const Facet& facet : whole.facets) {
      take_side(facet, whole.axis, whole.middle_m, -1, below);
      take_side(facet, whole.axis, whole.middle_m, 1, above);
    }
    facets += below.size() + above.size() - whole.facets.size();
    *longest = measured(std::move(below));
    parts.push_back(measured(std::move(above)));
  }
  std::vector<MeshPiece> pieces;
  for (const PartOfMesh& part : parts)
    if (!part.facets.empty()) pieces.push_back(farthest_of(part.facets));
  return pieces;
}

[[nodiscard]] MeshPiece together(const std::vector<MeshPiece>& pieces) {
  MeshPiece all;
  for (const MeshPiece& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  return each_once(std::move(all));
}

}  // namespace

std::vector<MeshPiece> pieces_of(std::vector<Facet> surface) {
  if (surface.empty()) return {};
  std::vector<MeshPiece> pieces;
  MeshPiece corners = corners_of(surface);
  // Those of its pieces: what is farthest of the whole would leave a fifth of a long link's radius out.
  if (corners.size() > most_convex_corners) corners = together(pieces = cut(surface));
  // What a cut of it would add are faces inside, which push those who are pressed into it out where they are not.
  if (is_full(surface, corners) && is_convex(surface, corners) && is_closed(surface)) return {std::move(corners)};
  if (pieces.empty()) pieces = cut(std::move(surface));
  return pieces;
}

}  // namespace hirosco::simulation
