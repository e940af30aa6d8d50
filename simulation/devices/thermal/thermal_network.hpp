// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace hirosco::simulation {

/// One lump: what of a craft has one temperature.
struct ThermalNode {
  double capacity_j_k{3000};  ///< above 0
  double radiating_m2{0};  ///< emissivity times area, towards space without a temperature of its own
  double to_sink_w_k{0};  ///< to what stays at `sink_c`
  double sink_c{0};
  double temperature_c{20};
};

/// A lumped thermal network: nodes that heat goes into, that are coupled to each other, and that radiate into space. C dT/dt = heat
/// + sum of G (T_other - T) + G_sink (T_sink - T) - eps A sigma T^4, by classic Runge-Kutta in steps that are short against the
/// fastest node.  Realtime: bounded, no allocation. Thread: one.
class ThermalNetwork {
 public:
  static constexpr std::size_t most_nodes = 12;
  /// An advance() takes no more steps; what is asked for beyond is not reckoned (advance() says how much was).
  static constexpr int most_steps = 256;

  /// As many of `nodes` as there is room for.
  void begin(std::span<const ThermalNode> nodes) noexcept;
  /// Heat that goes between two nodes for each K; replaces what was said before. 0: none.
  void couple(std::size_t one, std::size_t other, double w_k) noexcept;
  /// `heat_w[i]` goes into node i all the time. The seconds that were reckoned.
  double advance(double seconds, std::span<const double> heat_w) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] ThermalNode& node(std::size_t i) noexcept { return nodes_[i]; }
  [[nodiscard]] double temperature_c(std::size_t i) const noexcept { return nodes_[i].temperature_c; }
  /// Of a step: a fifth of the time constant of the fastest node at 150 degC.
  [[nodiscard]] double longest_step_s() const noexcept;

 private:
  using Values = std::array<double, most_nodes>;
  [[nodiscard]] Values slope(const Values& temperature_c, std::span<const double> heat_w) const noexcept;

  std::array<ThermalNode, most_nodes> nodes_{};
  std::array<Values, most_nodes> coupling_w_k_{};
  std::size_t count_{0};
};

}  // namespace hirosco::simulation
