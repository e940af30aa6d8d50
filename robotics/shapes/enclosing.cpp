// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/enclosing.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

namespace hirosco::robotics {
namespace {

using Points = std::vector<Vector3>;

/// A way around the sphere in even steps.
[[nodiscard]] Points directions(std::size_t count) {
  constexpr double golden_angle = std::numbers::pi * (3 - 2.2360679774997896964);
  Points all;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double around = golden_angle * static_cast<double>(i), wide = std::sqrt(1 - z * z);
    all.emplace_back(wide * std::cos(around), wide * std::sin(around), z);
  }
  return all;
}

/// Those of the points that are farthest in some direction.
[[nodiscard]] Points outermost(const Points& points, std::size_t count) {
  std::vector<std::size_t> found;
  for (const Vector3& direction : directions(count)) {
    std::size_t farthest = 0;
    double most = -HUGE_VAL;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (const double far = direction.dot(points[i]); far > most) {
        most = far;
        farthest = i;
      }
    found.push_back(farthest);
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  Points some;
  for (const std::size_t i : found) some.push_back(points[i]);
  return some;
}

/// A part of a surface: its triangles, cut where it is cut.
struct Piece {
  std::vector<std::array<Vector3, 3>> triangles;
  double volume_m3{0};
};

[[nodiscard]] Points corners_of(const Piece& piece) {
  Points points;
  points.reserve(3 * piece.triangles.size());
  for (const auto& triangle : piece.triangles) points.insert(points.end(), triangle.begin(), triangle.end());
  const auto before = [](const Vector3& a, const Vector3& b) {
    return std::tuple{a.x(), a.y(), a.z()} < std::tuple{b.x(), b.y(), b.z()};
  };
  std::ranges::sort(points, before);
  points.erase(std::ranges::unique(points).begin(), points.end());
  return points;
}

/// What is measured of a cut is coarse; what comes of it is not.
constexpr std::size_t coarse_directions = 48;

void measure(Piece& piece) {
  const Points points = corners_of(piece);
  piece.volume_m3 = points.empty() ? 0 : hull_volume_m3(outermost(points, coarse_directions));
}

/// What lies below and above a plane.
[[nodiscard]] std::pair<Piece, Piece> cut(const Piece& piece, const Vector3& normal, double at) {
  std::pair<Piece, Piece> halves;
  for (const auto& triangle : piece.triangles) {
    std::array<double, 3> height{};
    for (std::size_t i = 0; i < 3; ++i) height[i] = normal.dot(triangle[i]) - at;
    const auto [low, high] = std::ranges::minmax(height);
    if (high <= 0) {
      halves.first.triangles.push_back(triangle);
      continue;
    }
    if (low >= 0) {
      halves.second.triangles.push_back(triangle);
      continue;
    }
    // The corner that is alone on its side, and where the plane meets its two edges.
    std::size_t alone = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if ((height[i] > 0) != (height[(i + 1) % 3] > 0) && (height[i] > 0) != (height[(i + 2) % 3] > 0)) alone = i;
    const std::size_t next = (alone + 1) % 3, last = (alone + 2) % 3;
    const auto met = [&](std::size_t other) -> Vector3 {
      return triangle[alone] + height[alone] / (height[alone] - height[other]) * (triangle[other] - triangle[alone]);
    };
    const Vector3 to_next = met(next), to_last = met(last);
    auto& own = height[alone] > 0 ? halves.second : halves.first;
    auto& others = height[alone] > 0 ? halves.first : halves.second;
    own.triangles.push_back({triangle[alone], to_next, to_last});
    others.triangles.push_back({to_next, triangle[next], triangle[last]});
    others.triangles.push_back({to_next, triangle[last], to_last});
  }
  return halves;
}

/// So many triangles tell where to cut; more only take longer.
constexpr std::size_t telling_triangles = 1500;

[[nodiscard]] Piece thinned(const Piece& piece) {
  const std::size_t step = piece.triangles.size() / telling_triangles + 1;
  Piece some;
  for (std::size_t i = 0; i < piece.triangles.size(); i += step) some.triangles.push_back(piece.triangles[i]);
  measure(some);
  return some;
}

/// The best of some cuts across its main axes.
[[nodiscard]] std::optional<std::pair<Piece, Piece>> best_cut(const Piece& whole) {
  const Piece piece = thinned(whole);
  const Points points = corners_of(piece);
  if (points.size() < 8) return std::nullopt;
  Vector3 mean = Vector3::Zero();
  for (const Vector3& point : points) mean += point / static_cast<double>(points.size());
  Matrix3 spread = Matrix3::Zero();
  for (const Vector3& point : points) spread += (point - mean) * (point - mean).transpose();
  const Matrix3 axes = Eigen::SelfAdjointEigenSolver<Matrix3>{spread}.eigenvectors();
  struct Plane {
    Vector3 normal;
    double at;
  };
  std::optional<Plane> best;
  double least = piece.volume_m3;
  constexpr int steps = 10;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector3 normal = axes.col(axis);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Vector3& point : points) {
      low = std::min(low, normal.dot(point));
      high = std::max(high, normal.dot(point));
    }
    for (int i = 1; i < steps; ++i) {
      const double at = low + (high - low) * i / steps;
      auto halves = cut(piece, normal, at);
      if (halves.first.triangles.empty() || halves.second.triangles.empty()) continue;
      measure(halves.first);
      measure(halves.second);
      const double sum = halves.first.volume_m3 + halves.second.volume_m3;
      if (sum >= least) continue;
      least = sum;
      best = Plane{normal, at};
    }
  }
  if (!best) return std::nullopt;
  auto halves = cut(whole, best->normal, best->at);
  measure(halves.first);
  measure(halves.second);
  return halves;
}

}  // namespace

/// Points are added one by one to a closed surface of triangles, in place of those that they see.
double hull_volume_m3(std::span<const Vector3> points) {
  using Face = std::array<std::size_t, 3>;
  if (points.size() < 4) return 0;
  double size = 0;
  for (const Vector3& point : points) size = std::max(size, (point - points[0]).norm());
  const double tiny = 1e-9 * size;
  // Four points that are not in a plane.
  std::array<std::size_t, 4> first{};
  const auto farthest = [&](auto&& from) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (from(points[i]) > from(points[at])) at = i;
    return at;
  };
  first[1] = farthest([&](const Vector3& p) { return (p - points[0]).norm(); });
  const Vector3 line = (points[first[1]] - points[0]).normalized();
  first[2] = farthest([&](const Vector3& p) { return (p - points[0]).cross(line).norm(); });
  const Vector3 normal = (points[first[1]] - points[0]).cross(points[first[2]] - points[0]);
  if (!(normal.norm() > tiny * tiny)) return 0;
  first[3] = farthest([&](const Vector3& p) { return std::abs((p - points[0]).dot(normal)); });
  const double height = (points[first[3]] - points[0]).dot(normal) / normal.norm();
  if (!(std::abs(height) > tiny)) return 0;
  if (height > 0) std::swap(first[1], first[2]);  // seen from outside its corners go against the clock
  std::vector<Face> faces{{first[0], first[1], first[2]},
                          {first[0], first[3], first[1]},
                          {first[1], first[3], first[2]},
                          {first[2], first[3], first[0]}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<Face> kept;
    std::map<std::pair<std::size_t, std::size_t>, bool> rim;
    for (const Face& face : faces) {
      const Vector3 across = (points[face[1]] - points[face[0]]).cross(points[face[2]] - points[face[0]]);
      if ((points[i] - points[face[0]]).dot(across) <= tiny * across.norm()) {
        kept.push_back(face);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k)
        if (rim.erase({face[(k + 1) % 3], face[k]}) == 0) rim[{face[k], face[(k + 1) % 3]}] = true;
    }
    for (const auto& [edge, is] : rim) kept.push_back({edge.first, edge.second, i});
    faces = std::move(kept);
  }
  double volume = 0;
  for (const Face& face : faces)
    volume += (points[face[0]] - points[first[0]])
                  .dot((points[face[1]] - points[first[0]]).cross(points[face[2]] - points[first[0]])) /
              6;
  return volume;
}

/// The point that is farthest outside becomes a corner, again and again. What a point was outside it never is farther: it is looked at again only
/// when it is the first by what it was.
RoundedHull hull_around(std::vector<Vector3> points, const Fineness& fineness) {
  if (points.empty()) return {};
  RoundedHull hull;
  const std::size_t most = std::clamp<std::size_t>(fineness.most_corners, 1, RoundedHull::most_corners);
  // Six to begin with: a far end by each axis.
  for (const Vector3& corner : outermost(points, std::min<std::size_t>(most, 6))) static_cast<void>(hull.add(corner));
  const Pose here;
  const auto outside = [&](const Vector3& point) {
    const RoundedHull alone{std::span{&point, 1}, 0};
    Vector3 axis = Vector3::UnitZ();
    return distance_m({hull, here}, {alone, here}, HUGE_VAL, axis);
  };
  std::priority_queue<std::pair<double, std::size_t>> farthest;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const double far = outside(points[i]); far > 0) farthest.emplace(far, i);
  while (!farthest.empty()) {
    const auto [was, i] = farthest.top();
    farthest.pop();
    const double far = outside(points[i]);
    if (far < was - 1e-9 && !farthest.empty() && far < farthest.top().first) {
      if (far > 0) farthest.emplace(far, i);
      continue;
    }
    if (far <= fineness.tolerance_m || hull.corners() >= most) {
      hull.round(std::max(far, 0.0) + 2e-7);  // as exact as a distance is
      break;
    }
    static_cast<void>(hull.add(points[i]));
  }
  return hull;
}

std::vector<RoundedHull> enclosing(const Mesh& mesh, const Fineness& fineness) {
  std::vector<Piece> pieces(1);
  for (const Mesh::Triangle& triangle : mesh.triangles)
    pieces[0].triangles.push_back({mesh.points[triangle[0]], mesh.points[triangle[1]], mesh.points[triangle[2]]});
  measure(pieces[0]);
  const double whole_m3 = pieces[0].volume_m3;
  // What cutting it takes away: of each piece once.
  struct Cut {
    double gain_m3;
    std::optional<std::pair<Piece, Piece>> halves;
  };
  const auto tried = [](const Piece& piece) {
    Cut found{0, best_cut(piece)};
    if (found.halves) found.gain_m3 = piece.volume_m3 - found.halves->first.volume_m3 - found.halves->second.volume_m3;
    return found;
  };
  std::vector<Cut> cuts;
  if (fineness.most_hulls > 1) cuts.push_back(tried(pieces[0]));
  while (pieces.size() < fineness.most_hulls) {
    const auto best = std::ranges::max_element(cuts, {}, &Cut::gain_m3);
    if (!best->halves || best->gain_m3 < fineness.least_gain * whole_m3) break;
    const auto at = static_cast<std::size_t>(best - cuts.begin());
    auto halves = std::move(*best->halves);
    pieces[at] = std::move(halves.first);
    pieces.push_back(std::move(halves.second));
    cuts[at] = tried(pieces[at]);
    cuts.push_back(tried(pieces.back()));
  }
  std::vector<RoundedHull> hulls;
  for (const Piece& piece : pieces) hulls.push_back(hull_around(corners_of(piece), fineness));
  return hulls;
}

}  // namespace hirosco::robotics
