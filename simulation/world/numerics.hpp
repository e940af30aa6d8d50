// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace hirosco::simulation {

/// A pair of joint or planar Cartesian values.
using Vec2 = std::array<double, 2>;
/// Row-major 2 x 2.
using Mat2 = std::array<Vec2, 2>;

[[nodiscard]] constexpr double dot(const Vec2& a, const Vec2& b) noexcept { return a[0] * b[0] + a[1] * b[1]; }
/// Not std::hypot, whose last digit depends on the processor (docs/adr/0139). Squares of what this world has are far from overflow.
[[nodiscard]] inline double magnitude(const Vec2& v) noexcept { return std::sqrt(dot(v, v)); }
[[nodiscard]] constexpr Vec2 operator+(const Vec2& a, const Vec2& b) noexcept { return {a[0] + b[0], a[1] + b[1]}; }
[[nodiscard]] constexpr Vec2 operator-(const Vec2& a, const Vec2& b) noexcept { return {a[0] - b[0], a[1] - b[1]}; }
[[nodiscard]] constexpr Vec2 operator*(double s, const Vec2& a) noexcept { return {s * a[0], s * a[1]}; }
[[nodiscard]] constexpr Vec2 times(const Mat2& m, const Vec2& v) noexcept { return {dot(m[0], v), dot(m[1], v)}; }
[[nodiscard]] constexpr Vec2 transposed_times(const Mat2& m, const Vec2& v) noexcept {
  return {m[0][0] * v[0] + m[1][0] * v[1], m[0][1] * v[0] + m[1][1] * v[1]};
}
/// x of m x = v by Cramer's rule; m must be regular.
[[nodiscard]] constexpr Vec2 solve(const Mat2& m, const Vec2& v) noexcept {
  const double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  return {(m[1][1] * v[0] - m[0][1] * v[1]) / det, (m[0][0] * v[1] - m[1][0] * v[0]) / det};
}

/// One step of the classical Runge-Kutta method for a state of N numbers, autonomous `derivative(state) -> rates`.
template <class State, class Derivative>
[[nodiscard]] State runge_kutta_4(const State& x, double h, const Derivative& derivative) noexcept {
  const auto moved = [&x](const State& rate, double span) {
    State y = x;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += span * rate[i];
    return y;
  };
  const State k1 = derivative(x);
  const State k2 = derivative(moved(k1, h / 2));
  const State k3 = derivative(moved(k2, h / 2));
  const State k4 = derivative(moved(k3, h));
  State y = x;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  return y;
}

}  // namespace hirosco::simulation
