// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <simulation/devices/module.hpp>

namespace {

using namespace hirosco;
using namespace hirosco::simulation;

/// Glows after its current, by a time constant of 50 ms.
class LampDevice final : public SimulatedDevice {
 public:
  static constexpr std::array fault_lines{FaultLine{"old 0.5", "an old bulb, half as bright"}};

  LampDevice(FlowFactory& flows, const FlowAddress& address, const Settings& settings)
      : SimulatedDevice{flows, address, settings} {}

 private:
  void advance(Duration cycle) noexcept override {
    const double goal = active() ? health_ * commanded_a_ : 0.0;
    brightness_ += (goal - brightness_) * std::min(seconds(cycle) / 0.05, 1.0);
  }
  Result<> take(OctetReader payload) noexcept override {
    const auto current_a = payload.get<double>();
    if (!payload.exhausted()) return fail(ErrorCode::Malformed, "lamp command size");
    commanded_a_ = current_a;
    return ok();
  }
  void write_sensors(OctetWriter& payload) noexcept override { payload.put(brightness_); }
  Result<> do_fault(const Words& words) override {
    if (words[0] != "old") return fail(ErrorCode::InvalidArgument, "unknown fault");
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(health_, words.number(1, 0, 1));
    return ok();
  }
  std::string do_truth() const override { return "brightness=" + std::to_string(brightness_); }
  void do_heal() noexcept override { health_ = 1; }

  double commanded_a_{0};
  double brightness_{0};
  double health_{1};
};

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::simulation::device_module<LampDevice>; }
