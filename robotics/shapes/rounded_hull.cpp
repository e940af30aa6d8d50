// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/rounded_hull.hpp"

#include <algorithm>

namespace hirosco::robotics {
namespace {

constexpr double close_enough_m = 1e-7;
/// Nearer to the origin than this counts as there.
constexpr double touching_m = 1e-10;

/// At most four points of the difference of two hulls, of which the nearest to the origin is known.
class Simplex {
 public:
  [[nodiscard]] bool has(const Vector3& point) const noexcept {
    for (std::size_t i = 0; i < count_; ++i)
      if (points_[i] == point) return true;
    return false;
  }
  /// Null: the origin is inside. Of the points those are kept that span the nearest one.
  [[nodiscard]] const Vector3* with(const Vector3& point) noexcept {
    points_[count_++] = point;
    bool outside = true;
    switch (count_) {
      case 1: nearest_ = point; break;
      case 2: take(of_line(points_[0], points_[1])); break;
      case 3: take(of_triangle(points_[0], points_[1], points_[2])); break;
      default: outside = of_tetrahedron(); break;
    }
    return outside ? &nearest_ : nullptr;
  }

 private:
  struct Part {
    std::array<Vector3, 3> points;
    std::size_t count;
    Vector3 nearest;
  };
  void take(const Part& part) noexcept {
    std::copy_n(part.points.begin(), part.count, points_.begin());
    count_ = part.count;
    nearest_ = part.nearest;
  }

  static Part of_line(const Vector3& a, const Vector3& b) noexcept {
    const Vector3 ab = b - a;
    const double share = -a.dot(ab), whole = ab.squaredNorm();
    if (share <= 0 || whole <= 0) return {{a}, 1, a};
    if (share >= whole) return {{b}, 1, b};
    return {{a, b}, 2, a + (share / whole) * ab};
  }

  /// Which of its corners, edges or its inside is nearest to the origin (Ericson, Real-Time Collision Detection, 5.1.5).
  static Part of_triangle(const Vector3& a, const Vector3& b, const Vector3& c) noexcept {
    const Vector3 ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a);
    if (d1 <= 0 && d2 <= 0) return {{a}, 1, a};
    const double d3 = -ab.dot(b), d4 = -ac.dot(b);
    if (d3 >= 0 && d4 <= d3) return {{b}, 1, b};
    const double d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d6 >= 0 && d5 <= d6) return {{c}, 1, c};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return of_line(a, b);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return of_line(a, c);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return of_line(b, c);
    const double sum = va + vb + vc;
    if (!(sum > 0)) return of_line(a, b);  // it has no area
    return {{a, b, c}, 3, a + (vb / sum) * ab + (vc / sum) * ac};
  }

  /// False: it has the origin inside.
  bool of_tetrahedron() noexcept {
    const auto [a, b, c, d] = points_;
    Part best{{}, 0, Vector3::Constant(HUGE_VAL)};
    bool outside = false;
    const auto look = [&](const Vector3& p, const Vector3& q, const Vector3& r, const Vector3& opposite) {
      const Vector3 normal = (q - p).cross(r - p);
      // Of a flat one every face is looked at.
      if (normal.dot(-p) * normal.dot(opposite - p) > 0) return;
      outside = true;
      if (const Part part = of_triangle(p, q, r);
          best.count == 0 || part.nearest.squaredNorm() < best.nearest.squaredNorm())
        best = part;
    };
    look(a, b, c, d);
    look(a, b, d, c);
    look(a, c, d, b);
    look(b, c, d, a);
    if (outside) take(best);
    return outside;
  }

  std::array<Vector3, 4> points_{Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  std::size_t count_{0};
  Vector3 nearest_{Vector3::Zero()};
};

}  // namespace

RoundedHull::RoundedHull(std::span<const Vector3> corners, double radius_m) noexcept : radius_m_{radius_m} {
  for (const Vector3& corner : corners) static_cast<void>(add(corner));
}

bool RoundedHull::add(const Vector3& corner) noexcept {
  if (count_ == most_corners) return false;
  x_[count_] = corner.x();
  y_[count_] = corner.y();
  z_[count_] = corner.z();
  ++count_;
  return true;
}

Vector3 RoundedHull::farthest(const Vector3& direction) const noexcept {
  const double dx = direction.x(), dy = direction.y(), dz = direction.z();
  double most = -HUGE_VAL;
  std::size_t at = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double far = dx * x_[i] + dy * y_[i] + dz * z_[i];
    if (far > most) {
      most = far;
      at = i;
    }
  }
  return corner(at);
}

Ball ball_around(std::span<const RoundedHull> hulls) noexcept {
  Vector3 low = Vector3::Constant(HUGE_VAL), high = -low;
  for (const RoundedHull& hull : hulls)
    for (std::size_t i = 0; i < hull.corners(); ++i) {
      low = low.cwiseMin(hull.corner(i));
      high = high.cwiseMax(hull.corner(i));
    }
  Ball ball{(low + high) / 2, 0};
  for (const RoundedHull& hull : hulls)
    for (std::size_t i = 0; i < hull.corners(); ++i)
      ball.radius_m = std::max(ball.radius_m, (hull.corner(i) - ball.centre).norm() + hull.radius_m());
  return ball;
}

/// Gilbert, Johnson and Keerthi: the point of the difference of both hulls that is nearest to the origin. Every direction that is tried
/// bounds the distance from below by what the difference reaches against it.
double distance_m(const PlacedHull& one, const PlacedHull& other, double enough_m, Vector3& axis) noexcept {
  const double radii = one.hull.radius_m() + other.hull.radius_m();
  Simplex simplex;
  double least = 0;  // so far
  Vector3 direction = axis;
  double length = 1;
  for (int step = 0; step < most_search_steps; ++step) {
    const Vector3 point = one.pose * one.hull.farthest(one.pose.rotation.transpose() * -direction) -
                          other.pose * other.hull.farthest(other.pose.rotation.transpose() * direction);
    if (const double bound = direction.dot(point) / length; bound > least) {
      least = bound;
      axis = direction / length;
      if (least - radii >= enough_m) break;
    }
    if (step > 0 && (length - least <= close_enough_m || simplex.has(point))) break;
    const Vector3* nearest = simplex.with(point);
    if (nearest == nullptr) return -radii;
    direction = *nearest;
    length = direction.norm();
    if (length <= touching_m) return -radii;
  }
  return least - radii;
}

}  // namespace hirosco::robotics
