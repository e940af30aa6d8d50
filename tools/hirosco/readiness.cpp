// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/readiness.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "hirosco/data_transfer/simulated/simulated_flows.hpp"
#include "simulation/spacecraft/catalogue.hpp"
#include "supervisor/platform/process_launcher.hpp"

namespace hirosco::tools {
namespace {

using descriptor::Diagnostic;

class Findings {
 public:
  Findings(const descriptor::Mission& mission, Platform platform) : mission_{mission}, platform_{platform} {}

  void program(const std::string& executable, const std::string& user, descriptor::Location at, bool built_in) {
    const bool here = platform_ == Platform::Simulation ? built_in : !supervisor::find_program(executable).empty();
    if (here) return;
    add(at, "E0401", fmt::format("no program {} for {}", executable, user),
        platform_ == Platform::Simulation ? "it is not built into this program, which simulates all in one"
                                          : "it is neither beside this program nor in PATH");
  }

  void settings(const descriptor::SimulatedDevice& device, const simulation::MakeDevice& make) {
    SimulatedFlows flows;
    const auto played = make(flows, {0, device.name}, {});
    if (!played->plug()) return;
    for (const auto& [name, value] : device.settings) {
      const auto taken = played->fault(name + " " + value);
      // What is not available in this world may be in the device's own.
      if (taken || (platform_ == Platform::Processes && taken.error().code == ErrorCode::Unavailable)) continue;
      const auto place = device.setting_places.find(name);
      add(place == device.setting_places.end() ? device.at : place->second, "E0402",
          fmt::format("device {} does not take '{} {}'", device.name, name, value),
          fmt::format("{}: {}", to_text(taken.error().code), taken.error().text));
    }
  }

  [[nodiscard]] std::vector<Diagnostic> take() { return std::move(found_); }

 private:
  void add(descriptor::Location at, const char* code, std::string message, std::string hint) {
    found_.push_back({mission_.file, at, code, std::move(message), std::move(hint), 1});
  }

  const descriptor::Mission& mission_;
  Platform platform_;
  std::vector<Diagnostic> found_;
};

}  // namespace

std::vector<Diagnostic> unready(const descriptor::Mission& mission, Platform platform) {
  const auto& subsystems = simulation::known_subsystems();
  const auto& devices = simulation::known_devices();
  Findings findings{mission, platform};
  for (const auto& member : mission.subsystems) {
    const std::string& name = member.subsystem.name;
    // The ground link of a simulated spacecraft is made by the spacecraft itself.
    const bool built_in = name == mission.ground.subsystem || subsystems.contains(member.executable);
    findings.program(member.executable, "subsystem " + name, member.at, built_in);
  }
  for (const auto& device : mission.devices) {
    const auto make = devices.find(device.executable);
    findings.program(device.executable, "simulated device " + device.name, device.at, make != devices.end());
    if (make != devices.end()) findings.settings(device, make->second);
  }
  return findings.take();
}

bool ready(const descriptor::Mission& mission, Platform platform) {
  const auto found = unready(mission, platform);
  const bool colour = ::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
  for (const auto& problem : found)
    fmt::print(stderr, "{}", descriptor::render(problem, descriptor::file_system(), colour));
  return found.empty();
}

}  // namespace hirosco::tools
