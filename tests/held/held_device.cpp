// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "simulation/devices/module.hpp"

namespace {

using namespace hirosco;
using namespace hirosco::simulation;

/// An axis behind a power switch, which counts what it hears.
class HeldDevice final : public SimulatedDevice {
 public:
  HeldDevice(FlowFactory& flows, const FlowAddress& address, const Settings& settings)
      : SimulatedDevice{flows, address, settings} {}

 private:
  void advance(Duration cycle) noexcept override {
    if (active()) angle_rad_ += rate_rad_per_s_ * seconds(cycle);
  }
  Result<> take(OctetReader payload) noexcept override {
    const auto rate = payload.get<double>();
    if (!payload.exhausted()) return fail(ErrorCode::Malformed, "axis command size");
    rate_rad_per_s_ = rate;
    return ok();
  }
  void write_sensors(OctetWriter& payload) noexcept override { payload.put(angle_rad_); }
  Result<> do_fault(const Words&) override { return fail(ErrorCode::InvalidArgument, "unknown fault"); }
  std::string do_truth() const override {
    return fmt::format("angle={:.6f} active={} heard={}", angle_rad_, active() ? 1 : 0, cycles() - own_cycles());
  }

  double angle_rad_{0};
  double rate_rad_per_s_{0};
};

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::simulation::device_module<HeldDevice>; }
