// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "robotics/dynamics/spatial.hpp"

/// Shapes that can touch, and how far apart they are.
namespace hirosco::robotics {

/// All points that are no farther than a radius from the convex hull of some corners: a ball has one corner, a capsule two, a box eight and
/// no radius, and so has a piece of a mesh, whose radius is what its few corners leave out.
class RoundedHull {
 public:
  static constexpr std::size_t most_corners = 64;

  RoundedHull() = default;
  /// Of more corners than there is room for the first ones.
  RoundedHull(std::span<const Vector3> corners, double radius_m) noexcept;

  [[nodiscard]] std::size_t corners() const noexcept { return count_; }
  [[nodiscard]] Vector3 corner(std::size_t i) const noexcept { return {x_[i], y_[i], z_[i]}; }
  [[nodiscard]] double radius_m() const noexcept { return radius_m_; }
  /// False: there is no room for it.
  bool add(const Vector3& corner) noexcept;
  void round(double radius_m) noexcept { radius_m_ = radius_m; }

  /// The corner that is farthest in this direction.
  [[nodiscard]] Vector3 farthest(const Vector3& direction) const noexcept;

 private:
  std::array<double, most_corners> x_{}, y_{}, z_{};
  std::size_t count_{0};
  double radius_m_{0};
};

/// Encloses a hull, or several.
struct Ball {
  Vector3 centre{Vector3::Zero()};
  double radius_m{0};
};
[[nodiscard]] Ball ball_around(std::span<const RoundedHull> hulls) noexcept;

/// A hull where it stands.
struct PlacedHull {
  const RoundedHull& hull;
  const Pose& pose;
};

/// How the search for the least distance goes (GJK): never longer than that.
inline constexpr int most_search_steps = 32;

/// Never more than the distance between both surfaces, and at most 0.1 um less, but where it is no less than `enough_m`: that is all who asks wants
/// to know. Hulls whose corners span the same point are by both radii in each other. `axis`: of length 1, from the other to the one, where the last search ended; a
/// good first guess makes the next one short.  Realtime: wait-free.
[[nodiscard]] double distance_m(const PlacedHull& one, const PlacedHull& other, double enough_m,
                                Vector3& axis) noexcept;
[[nodiscard]] inline double distance_m(const PlacedHull& one, const PlacedHull& other) noexcept {
  Vector3 axis = Vector3::UnitZ();
  return distance_m(one, other, HUGE_VAL, axis);
}

}  // namespace hirosco::robotics
