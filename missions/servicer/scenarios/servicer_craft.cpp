// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/servicer/scenarios/servicer_craft.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "simulation/mujoco/base_device.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::uint16_t mcs_apid = 21;
constexpr double deg = 180 / std::numbers::pi;

template <class Numbers>
[[nodiscard]] double length(const Numbers& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number * number;
  return std::sqrt(sum);
}

}  // namespace

/// Objects of this program in place of modules, so that their worlds can be looked into.
Plan ServicerCraft::plan_of(const ServicerOptions& options) {
  Plan plan;
  plan.mission = options.mission;
  plan.seed = options.seed;
  plan.files = options.files;
  plan.subsystems = options.subsystems;
  plan.edit = [&options](descriptor::Mission& mission) {
    mission.start_mode = options.mode;
    for (auto& device : mission.devices) {
      for (auto& setting : device.settings) {
        if (setting.name == "posture" && !options.posture.empty()) setting.value = options.posture;
        if (setting.name.ends_with("_noise") && options.noise == Noise::None) setting.value = "0";
      }
      if (device.name == "arm") std::ranges::copy(options.arm_settings, std::back_inserter(device.settings));
    }
  };
  plan.devices["hirosco-sim-mujoco"] =
      [](FlowFactory& flows, const FlowAddress& address,
         const SimulatedDevice::Settings& settings) -> std::unique_ptr<SimulatedDevice> {
    if (settings.in_world_of != nullptr) return std::make_unique<BaseDevice>(flows, address, settings);
    return std::make_unique<MujocoDevice>(flows, address, settings);
  };
  return plan;
}

ServicerCraft::ServicerCraft(const ServicerOptions& options) : flight_{plan_of(options)} {
  if (!flight_.commission()) throw std::runtime_error{"not commissioned:\n" + flight_.story().text()};
  arm_ = &flight_.device<MujocoDevice>("arm");
}

void ServicerCraft::run(double seconds) { craft().run(Duration{std::llround(seconds * 1e9)}); }

double ServicerCraft::begin(std::string_view function, const std::vector<Value>& arguments) {
  std::optional<double> begun;
  flight_.story().on_telemetry = [&](const pus::TelemetryView& packet) {
    constexpr int started = 3;
    if (packet.apid() == mcs_apid && packet.service() == 1 && packet.subtype() == started) begun = time_s();
  };
  // It ends much later; what is waited for here is that it has begun.
  constexpr Duration limit = std::chrono::milliseconds{100};
  const auto outcome = craft().command("MCS", function, arguments, limit);
  flight_.story().on_telemetry = {};
  if (!begun || !outcome.started)
    throw std::runtime_error{"not begun: " + std::string{function} + "\n" + flight_.story().text()};
  return *begun;
}

void ServicerCraft::each_cycle(std::function<void()> watch) {
  craft().on_cycle([watch = std::move(watch)](std::string_view subsystem, TimePoint) {
    if (subsystem == "MCS") watch();
  });
}

ServicerCraft::Place ServicerCraft::tool_m() const {
  Place place;
  std::ranges::copy(robot().tip_m(), place.begin());
  return place;
}

double ServicerCraft::base_deg() const {
  const auto turned = robot().base().orientation(robot().data());
  return 2 * deg * std::atan2(std::hypot(turned[1], turned[2], turned[3]), std::abs(turned[0]));
}
double ServicerCraft::base_deg_s() const { return deg * length(robot().base().rate_rad_s(robot().data())); }

double ServicerCraft::fastest_joint_rad_s() const {
  double fastest = 0;
  for (std::size_t i = 0; i < robot().joints(); ++i) fastest = std::max(fastest, std::abs(robot().velocity(i)));
  return fastest;
}

double ServicerCraft::momentum_n_m_s() const {
  return length(robot().base().momentum(robot().model(), robot().data()).angular_n_m_s);
}

}  // namespace hirosco::simulation
