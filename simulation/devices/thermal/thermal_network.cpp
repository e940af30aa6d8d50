// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/thermal/thermal_network.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::simulation {
namespace {

constexpr double stefan_boltzmann_w_m2_k4 = 5.670374419e-8;
constexpr double kelvin = 273.15;

}  // namespace

void ThermalNetwork::begin(std::span<const ThermalNode> nodes) noexcept {
  count_ = std::min(nodes.size(), most_nodes);
  std::copy_n(nodes.begin(), count_, nodes_.begin());
  coupling_w_k_ = {};
}

void ThermalNetwork::couple(std::size_t one, std::size_t other, double w_k) noexcept {
  if (one >= count_ || other >= count_ || one == other) return;
  coupling_w_k_[one][other] = coupling_w_k_[other][one] = w_k;
}

double ThermalNetwork::longest_step_s() const noexcept {
  constexpr double hot_k = kelvin + 150, share = 0.2;
  double shortest_s = 3600;
  for (std::size_t i = 0; i < count_; ++i) {
    const ThermalNode& node = nodes_[i];
    double w_k = node.to_sink_w_k + 4 * stefan_boltzmann_w_m2_k4 * node.radiating_m2 * hot_k * hot_k * hot_k;
    for (std::size_t j = 0; j < count_; ++j) w_k += coupling_w_k_[i][j];
    if (w_k > 0) shortest_s = std::min(shortest_s, node.capacity_j_k / w_k);
  }
  return share * shortest_s;
}

ThermalNetwork::Values ThermalNetwork::slope(const Values& temperature_c,
                                             std::span<const double> heat_w) const noexcept {
  Values k_s{};
  for (std::size_t i = 0; i < count_; ++i) {
    const ThermalNode& node = nodes_[i];
    const double t_c = temperature_c[i];
    const double t_k = std::max(0.0, t_c + kelvin);
    double into_w = i < heat_w.size() ? heat_w[i] : 0;
    into_w += node.to_sink_w_k * (node.sink_c - t_c);
    into_w -= stefan_boltzmann_w_m2_k4 * node.radiating_m2 * t_k * t_k * t_k * t_k;
    for (std::size_t j = 0; j < count_; ++j) into_w += coupling_w_k_[i][j] * (temperature_c[j] - t_c);
    k_s[i] = into_w / node.capacity_j_k;
  }
  return k_s;
}

double ThermalNetwork::advance(double seconds, std::span<const double> heat_w) noexcept {
  if (count_ == 0 || !(seconds > 0)) return 0;
  const double longest_s = longest_step_s();
  const int steps = static_cast<int>(std::clamp(std::ceil(seconds / longest_s), 1.0, double{most_steps}));
  const double h_s = std::min(seconds / steps, longest_s);
  Values t_c{};
  for (std::size_t i = 0; i < count_; ++i) t_c[i] = nodes_[i].temperature_c;
  const auto gone = [&](const Values& k_s, double by_s) {
    Values then = t_c;
    for (std::size_t i = 0; i < count_; ++i) then[i] += by_s * k_s[i];
    return then;
  };
  for (int step = 0; step < steps; ++step) {
    const Values k1 = slope(t_c, heat_w);
    const Values k2 = slope(gone(k1, h_s / 2), heat_w);
    const Values k3 = slope(gone(k2, h_s / 2), heat_w);
    const Values k4 = slope(gone(k3, h_s), heat_w);
    for (std::size_t i = 0; i < count_; ++i) t_c[i] += h_s / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  for (std::size_t i = 0; i < count_; ++i) nodes_[i].temperature_c = t_c[i];
  return h_s * steps;
}

}  // namespace hirosco::simulation
