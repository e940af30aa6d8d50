// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "simulation/devices/module.hpp"

namespace {

using namespace hirosco;
using namespace hirosco::simulation;

/// A camera on an axis that turns at the rate that it is told. Pictures are as bright as their exposure is long.
class ImagerDevice final : public SimulatedDevice {
 public:
  ImagerDevice(FlowFactory& flows, const FlowAddress& address, const Settings& settings)
      : SimulatedDevice{flows, address, settings} {}

 private:
  void advance(Duration cycle) noexcept override {
    if (active()) angle_rad_ += rate_rad_per_s_ * seconds(cycle);
    if (powered()) ++pictures_;
  }
  Result<> take(OctetReader payload) noexcept override {
    const auto rate = payload.get<double>();
    if (!payload.exhausted()) return fail(ErrorCode::Malformed, "pointing command size");
    rate_rad_per_s_ = rate;
    return ok();
  }
  void write_sensors(OctetWriter& payload) noexcept override { payload.put(angle_rad_); }
  Result<> take_at(std::string_view endnode, OctetReader payload) noexcept override {
    if (endnode != "COMMAND") return SimulatedDevice::take_at(endnode, payload);
    const auto exposure = payload.get<float>();
    if (!payload.exhausted()) return fail(ErrorCode::Malformed, "exposure command size");
    exposure_ms_ = exposure;
    return ok();
  }
  void write_sensors_at(std::string_view endnode, OctetWriter& payload) noexcept override {
    if (endnode == "COMMAND") payload.put(exposure_ms_);
    if (endnode == "STATUS") payload.put(20.5F);
    if (endnode != "IMAGE") return;
    payload.put(pictures_);
    for (int pixel = 0; pixel < 64; ++pixel) payload.put(static_cast<std::uint8_t>(exposure_ms_));
  }
  bool can(Stop stop) const noexcept override { return stop != Stop::Controlled; }
  Result<> do_fault(const Words&) override { return fail(ErrorCode::InvalidArgument, "unknown fault"); }
  std::string do_truth() const override {
    return fmt::format("angle={:.6f} moves={} exposure={:.1f}", angle_rad_, active() && rate_rad_per_s_ != 0 ? 1 : 0,
                       exposure_ms_);
  }

  double angle_rad_{0};
  double rate_rad_per_s_{0};
  float exposure_ms_{0};
  std::uint32_t pictures_{0};
};

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::simulation::device_module<ImagerDevice>; }
