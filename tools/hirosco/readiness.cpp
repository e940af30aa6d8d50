// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/readiness.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "robotics/urdf/robot.hpp"
#include "simulation/devices/device_arguments.hpp"
#include "simulation/spacecraft/modules.hpp"
#include "supervisor/platform/launch/interpreter.hpp"
#include "supervisor/platform/launch/own_users.hpp"
#include "supervisor/platform/launch/program_image.hpp"
#include "tools/hirosco/core_places.hpp"

namespace hirosco::tools {
namespace {

using descriptor::Diagnostic;

/// All that is said of the URDF files among these.
struct UrdfFindings {
  std::vector<Diagnostic> problems, warnings;
};
[[nodiscard]] UrdfFindings urdf_findings(const std::map<std::string, std::string>& files) {
  UrdfFindings findings;
  for (const auto& [name, file] : files) {
    if (!file.ends_with(".urdf")) continue;
    auto reading = robotics::urdf::read(file, descriptor::file_system());
    std::ranges::move(reading.problems, std::back_inserter(findings.problems));
    std::ranges::move(reading.warnings, std::back_inserter(findings.warnings));
  }
  return findings;
}

class Lacking {
 public:
  Lacking(const descriptor::Mission& mission, FlownAs flown_as) : mission_{mission}, flown_as_{flown_as} {}

  /// Why the program cannot be had for such a flight; `missing`: what its module says.
  void subsystem(const std::string& executable, const std::string& user, descriptor::Location at,
                 const std::string& missing) {
    part(executable, user, at, missing, flown_as_ == FlownAs::Processes);
  }
  void device(const std::string& executable, const std::string& user, descriptor::Location at,
              const std::string& missing) {
    part(executable, user, at, missing, flown_as_ != FlownAs::Simulation);
  }
  void part(const std::string& executable, const std::string& user, descriptor::Location at, const std::string& missing,
            bool as_program) {
    if (as_program && find_program(executable).empty())
      add(at, "E0401", fmt::format("no program {} for {}", executable, user),
          "it is neither beside this program nor in PATH");
    if (!as_program && !missing.empty())
      add(at, "E0404", fmt::format("no module {} for {}", executable, user), missing);
  }

  /// It would not be started by the mission's manifest.
  void listed(const descriptor::MissionSubsystem& member) {
    const auto* listed = mission_.manifest->find(member.executable);
    const std::string hint =
        fmt::format("if what is here is meant: hirosco manifest {} --write", mission_.file.string());
    if (listed == nullptr)
      return add(member.at, "E0364",
                 fmt::format("{} of subsystem {} is not in the manifest {}", member.executable, member.subsystem.name,
                             mission_.manifest->file.string()),
                 hint);
    const auto file = find_program(member.executable);
    if (file.empty()) return;  // which is told already
    const auto image = supervisor::ProgramImage::read(file);
    if (!image) return add(member.at, "E0401", fmt::format("{}: {}", file.string(), image.error().text), "");
    if (image->digest() != listed->digest)
      add(member.at, "E0365",
          fmt::format("{} has the SHA-256 {}, the manifest says {}", file.string(), image->digest(), listed->digest),
          hint);
  }

  /// What a subsystem that is a user of its own does not get at, and whose number it has (docs/adr/0177).
  void own_user(const descriptor::MissionSubsystem& member, std::uint32_t user) {
    const auto cannot = [&](const std::string& why, const char* hint) {
      add(member.at, "E0368", fmt::format("{} cannot be user {}: {}", member.subsystem.name, user, why), hint);
    };
    if (const passwd* const account = ::getpwuid(user); account != nullptr)
      return cannot(fmt::format("that is {}", account->pw_name),
                    "numbers that no account has, for example 60600-60699");
    // One that runs from memory has no file.
    const auto program = mission_.manifest ? std::filesystem::path{} : find_program(member.executable);
    if (const auto closed = supervisor::what_is_closed(member, user, program, flight_instance()); !closed.empty())
      cannot("it " + closed, "chmod o+rx of what is closed, or all of it where everybody may read: /opt, /usr/local");
  }

  /// As a flight would make it: what it takes may depend on the files that it is given, and on what else is in its world.
  void settings(const descriptor::SimulatedDevice& device, const simulation::MakeDevice& make) {
    LocalFlows flows;
    const auto none = [&](std::string_view why) {
      add(device.at, "E0407", fmt::format("no simulated device {}: {}", device.name, why), "");
    };
    const auto world = simulation::whose_world(mission_, device);
    if (!world) return none(world.error());
    // All that is in the world before it; what is wrong with these is told by themselves.
    std::vector<std::unique_ptr<simulation::SimulatedDevice>> before;
    for (const descriptor::SimulatedDevice& each : mission_.devices) {
      if (*world == nullptr || &each == &device) break;
      const auto its = simulation::whose_world(mission_, each);
      if (&each != *world && (!its || *its != *world)) continue;
      auto other = made(each, make, flows, before.empty() ? nullptr : before.front().get());
      if (other) before.push_back(std::move(other));
      else if (&each == *world) return;
    }
    simulation::SimulatedDevice* other = before.empty() ? nullptr : before.front().get();
    auto wanted = simulation::device_arguments(mission_, device);
    if (!wanted) return none(wanted.error());
    wanted->settings.in_world_of = other;
    const auto played = make(flows, wanted->address(), wanted->settings);
    if (const auto plugged = played->plug(); !plugged) {
      if (misread(wanted->settings.files)) return;
      return none(plugged.error().text);
    }
    for (const auto& [name, value, at] : device.settings) {
      if (name == simulation::world_setting) continue;
      const auto taken = played->fault(name + " " + value);
      // What is not available in this world may be in the device's own.
      if (taken || (flown_as_ != FlownAs::Simulation && taken.error().code == ErrorCode::Unavailable)) continue;
      add(at, "E0402", fmt::format("device {} does not take '{} {}'", device.name, name, value),
          fmt::format("{}: {}", to_text(taken.error().code), taken.error().text));
    }
  }

  [[nodiscard]] std::vector<Diagnostic> take() { return std::move(found_); }

 private:
  /// What the reader of this project says of a robot that a world did not take: with its place in that file, and what to do.
  [[nodiscard]] bool misread(const std::map<std::string, std::string>& files) {
    auto problems = urdf_findings(files).problems;
    // Of one that is not there the mission's place says more.
    std::erase_if(problems, [](const Diagnostic& problem) { return problem.code == "U0001"; });
    const bool any = !problems.empty();
    std::ranges::move(problems, std::back_inserter(found_));
    return any;
  }

  /// With its settings, as far as it takes them. Null: it cannot be.
  [[nodiscard]] std::unique_ptr<simulation::SimulatedDevice> made(const descriptor::SimulatedDevice& device,
                                                                  const simulation::MakeDevice& make,
                                                                  FlowFactory& flows,
                                                                  simulation::SimulatedDevice* in_world_of) const {
    auto wanted = simulation::device_arguments(mission_, device);
    if (!wanted) return nullptr;
    wanted->settings.in_world_of = in_world_of;
    auto device_made = make(flows, wanted->address(), wanted->settings);
    if (!device_made->plug()) return nullptr;
    for (const auto& [name, value, at] : device.settings)
      if (name != simulation::world_setting) (void)device_made->fault(name + " " + value);
    return device_made;
  }

  void add(descriptor::Location at, const char* code, std::string message, std::string hint) {
    found_.push_back({mission_.file, at, code, std::move(message), std::move(hint), 1});
  }

  const descriptor::Mission& mission_;
  FlownAs flown_as_;
  std::vector<Diagnostic> found_;
};

}  // namespace

std::vector<Diagnostic> unready(const descriptor::Mission& mission, FlownAs flown_as) {
  const auto modules = simulation::load_modules(mission);
  const auto missing = [&](const std::string& executable) {
    const auto found = modules.missing.find(executable);
    return found != modules.missing.end() ? found->second : std::string{};
  };
  Lacking findings{mission, flown_as};
  // Without the right to it all are of the user who flies, which is told at the start.
  const bool own_users =
      flown_as == FlownAs::Processes && mission.users && supervisor::why_one_user(mission, true).empty();
  for (const auto& member : mission.subsystems) {
    std::string why_not = missing(member.executable);
    const auto maker = modules.subsystems.find(member.executable);
    if (flown_as == FlownAs::Simulation && member.subsystem.name == mission.ground.subsystem &&
        maker != modules.subsystems.end() && !maker->second.make_on_transport)
      why_not = simulation::SubsystemMaker::no_ground_link;
    findings.subsystem(member.executable, "subsystem " + member.subsystem.name, member.at, why_not);
    if (flown_as == FlownAs::Processes && mission.manifest) findings.listed(member);
    if (own_users && member.user) findings.own_user(member, *member.user);
  }
  for (const auto& device : mission.devices) {
    findings.device(device.executable, "simulated device " + device.name, device.at, missing(device.executable));
    if (const auto make = modules.devices.find(device.executable); make != modules.devices.end())
      findings.settings(device, make->second);
  }
  return findings.take();
}

std::vector<Diagnostic> unlikely(const descriptor::Mission& mission) {
  std::vector<Diagnostic> found;
  std::set<std::string> looked_at;
  for (const auto& device : mission.devices) {
    auto wanted = simulation::device_arguments(mission, device);
    if (!wanted) continue;  // told already
    std::erase_if(wanted->settings.files, [&](const auto& file) { return !looked_at.insert(file.second).second; });
    for (auto& warning : urdf_findings(wanted->settings.files).warnings)
      if (warning.code == "U0509") found.push_back(std::move(warning));
  }
  return found;
}

std::vector<Diagnostic> unloadable(const descriptor::Mission& mission) {
  const auto modules = simulation::load_modules(mission);
  Lacking findings{mission, FlownAs::Simulation};
  const auto refused = [&](const std::string& executable) {
    const auto found = modules.missing.find(executable);
    return found != modules.missing.end() && !find_module(executable).empty() ? found->second : std::string{};
  };
  for (const auto& member : mission.subsystems)
    findings.subsystem(member.executable, "subsystem " + member.subsystem.name, member.at, refused(member.executable));
  for (const auto& device : mission.devices)
    findings.device(device.executable, "simulated device " + device.name, device.at, refused(device.executable));
  return findings.take();
}

std::vector<Diagnostic> unintroduced(const descriptor::Mission& mission) {
  const auto modules = simulation::load_modules(mission);
  std::vector<Diagnostic> found;
  for (const auto& member : mission.subsystems) {
    const auto maker = modules.subsystems.find(member.executable);
    if (maker == modules.subsystems.end()) continue;
    const auto author = maker->second.make();
    for (const Mistake& made : simulation::try_introduction(*author, member.subsystem))
      if (made.at) found.push_back({member.subsystem.file, *made.at, made.code, made.text, made.remedy, 1});
      else
        found.push_back({mission.file, member.at, made.code, member.subsystem.name + ": " + made.text, made.remedy, 1});
  }
  return found;
}

std::vector<Diagnostic> unisolated(const descriptor::Mission& mission) {
  std::vector<Diagnostic> found;
  const auto grade = mission.isolation_required ? descriptor::Grade::Error : descriptor::Grade::Warning;
  for (const auto& member : mission.subsystems) {
    const auto program = find_program(member.executable);
    const auto interpreter = supervisor::interpreter_of(program);
    if (!interpreter || interpreter->open.empty()) continue;
    found.push_back(
        {mission.file, member.at, "E0411",
         fmt::format("{} of subsystem {} is a script {}: {}", member.executable, member.subsystem.name,
                     mission.isolation_required ? "that <Isolation required=\"yes\"/> does not let fly"
                                                : "that flies in no sandbox",
                     interpreter->open),
         "files, calls and processes of others are open to it; a first line that names the interpreter itself, as "
         "#!/usr/bin/python3, has a sandbox",
         1, grade});
  }
  return found;
}

bool ready(const descriptor::Mission& mission, FlownAs flown_as) {
  auto found = unready(mission, flown_as);
  if (flown_as != FlownAs::Simulation)
    std::ranges::move(core_problems(mission, ProcessorSet::of_this_thread()), std::back_inserter(found));
  const bool colour = ::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
  for (const auto& problem : found)
    fmt::print(stderr, "{}", descriptor::render(problem, descriptor::file_system(), colour));
  return found.empty();
}

}  // namespace hirosco::tools
