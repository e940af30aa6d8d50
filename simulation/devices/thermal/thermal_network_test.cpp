// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/thermal/thermal_network.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hirosco::simulation {
namespace {

constexpr double sigma = 5.670374419e-8, zero_c = 273.15;

/// T(t) = T_sink + P/G + (T_0 - T_sink - P/G) exp(-t G/C)
TEST(ThermalNetwork, OneNodeAndASinkFollowTheExponential) {
  ThermalNetwork network;
  const std::array nodes{ThermalNode{.capacity_j_k = 500, .to_sink_w_k = 0.25, .sink_c = -20, .temperature_c = 15}};
  network.begin(nodes);
  const std::array heat_w{5.0};
  double passed_s = 0;
  for (const double step_s : {1.0, 99.0, 400.0, 1500.0, 4000.0}) {
    EXPECT_NEAR(network.advance(step_s, heat_w), step_s, 1e-9);
    passed_s += step_s;
    const double end_c = -20 + 5 / 0.25;
    EXPECT_NEAR(network.temperature_c(0), end_c + (15 - end_c) * std::exp(-passed_s * 0.25 / 500), 2e-4) << passed_s;
  }
}

/// P = eps A sigma T^4
TEST(ThermalNetwork, WhatRadiatesComesToRestWhereItRadiatesWhatItGets) {
  ThermalNetwork network;
  const std::array nodes{ThermalNode{.capacity_j_k = 50, .radiating_m2 = 0.02, .temperature_c = -60}};
  network.begin(nodes);
  const std::array heat_w{8.0};
  for (int i = 0; i < 200; ++i) network.advance(60, heat_w);
  EXPECT_NEAR(network.temperature_c(0) + zero_c, std::pow(8 / (0.02 * sigma), 0.25), 1e-6);
}

/// Nothing in or out: what is in both stays, and they meet at the mean of their capacities.
TEST(ThermalNetwork, TwoThatAreCoupledMeetAndLoseNothing) {
  ThermalNetwork network;
  const std::array nodes{ThermalNode{.capacity_j_k = 300, .temperature_c = 40},
                         ThermalNode{.capacity_j_k = 100, .temperature_c = -40}};
  network.begin(nodes);
  network.couple(0, 1, 0.5);
  const std::array heat_w{0.0, 0.0};
  network.advance(100, heat_w);
  const double apart_k = network.temperature_c(0) - network.temperature_c(1);
  EXPECT_NEAR(apart_k, 80 * std::exp(-100 * 0.5 * (1.0 / 300 + 1.0 / 100)), 1e-3);
  for (int i = 0; i < 50; ++i) network.advance(100, heat_w);
  EXPECT_NEAR(network.temperature_c(0), 20, 1e-6);
  EXPECT_NEAR(network.temperature_c(1), 20, 1e-6);
}

/// A row of three between a heater and a sink: the same flow through both couplings.
TEST(ThermalNetwork, InARowEachCouplingCarriesTheWholeFlow) {
  ThermalNetwork network;
  const std::array nodes{ThermalNode{.capacity_j_k = 20}, ThermalNode{.capacity_j_k = 20},
                         ThermalNode{.capacity_j_k = 20, .to_sink_w_k = 1, .sink_c = 0}};
  network.begin(nodes);
  network.couple(0, 1, 0.2);
  network.couple(1, 2, 0.4);
  const std::array heat_w{2.0, 0.0, 0.0};
  for (int i = 0; i < 100; ++i) network.advance(100, heat_w);
  EXPECT_NEAR(network.temperature_c(2), 2, 1e-6);
  EXPECT_NEAR(network.temperature_c(1), 2 + 5, 1e-6);
  EXPECT_NEAR(network.temperature_c(0), 2 + 5 + 10, 1e-6);
}

TEST(ThermalNetwork, ReckonsNoFurtherThanItsStepsGo) {
  ThermalNetwork network;
  const std::array nodes{ThermalNode{.capacity_j_k = 10, .to_sink_w_k = 1}};
  network.begin(nodes);
  const std::array heat_w{1.0};
  EXPECT_NEAR(network.advance(1e9, heat_w), ThermalNetwork::most_steps * network.longest_step_s(), 1e-6);
  EXPECT_EQ(network.advance(0, heat_w), 0);
}

}  // namespace
}  // namespace hirosco::simulation
