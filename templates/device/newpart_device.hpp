// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <simulation/devices/simulated_device.hpp>
#include <string>

/// A plate of 20 J/K that loses 0.5 W for each kelvin above its surroundings. Here and not in its module, so that a test may have it beside the
/// subsystem: a program has one hirosco_module().
class NewPartDevice final : public hirosco::simulation::SimulatedDevice {
 public:
  static constexpr std::array fault_lines{
      hirosco::simulation::FaultLine{"heater 0.5", "the heater gives half of what it is told"}};

  NewPartDevice(hirosco::FlowFactory& flows, const hirosco::FlowAddress& address, const Settings& settings)
      : SimulatedDevice{flows, address, settings} {}

 private:
  void advance(hirosco::Duration cycle) noexcept override {
    const double power_w = active() ? health_ * commanded_w_ : 0.0;
    temperature_k_ += (power_w - loss_w_per_k * (temperature_k_ - outside_k)) / heat_j_per_k * hirosco::seconds(cycle);
  }
  hirosco::Result<> take(hirosco::OctetReader payload) noexcept override {
    const auto power_w = payload.get<double>();
    if (!payload.exhausted()) return hirosco::fail(hirosco::ErrorCode::Malformed, "size of the command");
    commanded_w_ = power_w;
    return hirosco::ok();
  }
  void write_sensors(hirosco::OctetWriter& payload) noexcept override { payload.put(temperature_k_); }
  hirosco::Result<> do_fault(const hirosco::simulation::Words& words) override {
    if (words[0] != "heater") return hirosco::fail(hirosco::ErrorCode::InvalidArgument, "unknown fault");
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(health_, words.number(1, 0, 1));
    return hirosco::ok();
  }
  std::string do_truth() const override { return "temperature_k=" + std::to_string(temperature_k_); }
  void do_heal() noexcept override { health_ = 1; }

  static constexpr double outside_k = 290, loss_w_per_k = 0.5, heat_j_per_k = 20;
  double commanded_w_{0};
  double temperature_k_{outside_k};
  double health_{1};
};
