// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdlib>
#include <set>
#include <string>
#include <tuple>

#include "hirosco/descriptor/model/cores.hpp"
#include "hirosco/descriptor/model/response_time.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/xml/reader.hpp"
#include "supervisor/supervision/event_handling/planned_reactions.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/core_places.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/permits.hpp"
#include "tools/hirosco/readiness.hpp"
#include "tools/hirosco/scripts.hpp"

namespace hirosco::tools {
namespace {

/// By the root element, whatever comments say.
[[nodiscard]] bool is_mission(std::string_view text) {
  xml::Reader reader{text};
  for (auto event = reader.next(); event && event->kind != xml::Event::Kind::Finished; event = reader.next())
    if (event->kind == xml::Event::Kind::Start) return event->name == "Mission";
  return false;
}

void show_field(const char* direction, const descriptor::Field& field) {
  fmt::print("    {} {} {}{}{}", direction, field.name, to_text(field.type),
             field.count == 1 ? "" : fmt::format("[{}]", field.count), field.unit.empty() ? "" : " " + field.unit);
  if (field.minimum) fmt::print(", at least {}", to_string(*field.minimum));
  if (field.maximum) fmt::print(", at most {}", to_string(*field.maximum));
  fmt::print("\n");
}

void show_subsystem(const descriptor::SubsystemDescriptor& subsystem) {
  fmt::print("subsystem {} (APID {}): {} parameters, {} functions, {} events\n", subsystem.name, subsystem.id,
             subsystem.parameters.size(), subsystem.functions.size(), subsystem.events.size());
  for (const auto& configuration : subsystem.configurations)
    fmt::print("  configuration {} ({}): {} us, priority {}, provides {}, requires {}, devices {}, structures {}\n",
               configuration.name, configuration.id, configuration.sampling / 1us, configuration.priority,
               configuration.provides.size(), configuration.requires_.size(), configuration.devices.size(),
               configuration.housekeeping.size() + subsystem.housekeeping.size());
  for (const auto& parameter : subsystem.parameters)
    if (parameter.persistent) show_field("keeps", parameter.field);
  for (const auto& device : subsystem.devices) {
    fmt::print("  device {}{}\n", device.name, device.actuator ? ", an actuator" : "");
    for (const auto& power : subsystem.power_switches)
      if (power.device == (device.part_of.empty() ? device.name : device.part_of))
        fmt::print("    with a power switch\n");
    for (const auto& field : device.input) show_field("says", field);
    for (const auto& output : device.output) show_field("takes", output.field);
  }
}

/// What is not declared takes nothing here, and the machine takes something: this is a bound for what stands in the descriptors.
void show_cycle(const descriptor::CycleResponse& cycle) {
  const std::string budget =
      cycle.budget() > Duration{} ? fmt::format("{} us", cycle.budget() / 1us) : "no budget declared";
  const std::string spin = cycle.spin() > Duration{} ? fmt::format(" after {} us of spin", cycle.spin() / 1us) : "";
  const std::string core = cycle.core ? fmt::format(" on core {}", *cycle.core) : "";
  fmt::print("  {} {} {}{}: {}{}, priority {}, ends at most {} us after it is due, due again after {} us\n",
             cycle.loop != nullptr ? "loop" : "cycle", cycle.subsystem, cycle.name(), core, budget, spin,
             cycle.priority(), cycle.longest ? fmt::format("{}", *cycle.longest / 1us) : "?", cycle.period() / 1us);
}

/// Which file it may be, and which are versions of it.
void show_program(const std::string& program, const descriptor::Manifest& manifest) {
  for (const auto& [file, digest, at] : manifest.listed)
    if (file == program || file.starts_with(program + descriptor::version_mark))
      fmt::print("  executable {}: SHA-256 {}\n", file, digest);
}

void show_mission(const descriptor::Mission& mission) {
  fmt::print("mission {}\n", mission.name);
  if (mission.manifest)
    fmt::print("manifest {}: {} executables\n", mission.manifest->file.string(), mission.manifest->listed.size());
  show_subsystem(mission.supervisor);
  for (const auto& member : mission.subsystems) {
    show_subsystem(member.subsystem);
    if (mission.manifest) show_program(member.executable, *mission.manifest);
    if (!member.starts) fmt::print("  is not started with the flight\n");
    if (member.cores.cycle)
      fmt::print("  its cycle goes on core {}{}\n", *member.cores.cycle, member.cores.alone ? ", alone" : "");
    if (!member.cores.services.empty())
      fmt::print("  its service loop goes on {}\n", to_string(ProcessorSet::of(member.cores.services)));
  }
  for (const auto& link : mission.links)
    fmt::print("link {}: {}.{} -> {}.{}\n", link.id, link.from, link.provides, link.to, link.requires_);
  for (const auto& mode : mission.modes) {
    if (descriptor::names_cores(mission)) {
      fmt::print("mode {} ({}):\n", mode.name, mode.id);
      for (const auto& [core, share] : descriptor::core_shares(mission, mode))
        fmt::print("  cycles take {:.0f} % of {}\n", 100 * share, descriptor::core_words(core));
    } else {
      fmt::print("mode {} ({}): cycles take {:.0f} % of their processor\n", mode.name, mode.id,
                 100 * descriptor::cycle_share(mission, mode));
    }
    const auto in_it = descriptor::cycle_responses(mission, mode);
    for (const auto& cycle : in_it) show_cycle(cycle);
    const auto around = descriptor::cycle_responses_around(mission, mode);
    if (around.size() == in_it.size()) continue;  // no loop of services goes otherwise in a configuration
    fmt::print("  while not all that it commissions is configured:\n");
    for (const auto& cycle : around) show_cycle(cycle);
  }
}

/// Nothing is flown: which plan would answer, event by event.
void show_recovery(const descriptor::Mission& mission) {
  for (const supervisor::PlannedReaction& each : supervisor::planned_reactions(mission)) {
    const bool everywhere = each.modes.size() == mission.modes.size();
    const bool usual = each.priority == descriptor::default_plan_priority;
    fmt::print("{} {} {}: plan {}{}: {}{}\n", each.subsystem, to_text(each.severity), each.event, each.plan,
               usual ? std::string{} : fmt::format(" (priority {})", each.priority), each.steps,
               everywhere ? std::string{} : fmt::format(" (in {})", fmt::join(each.modes, ", ")));
  }
  for (const supervisor::PlannedPreemption& each : supervisor::planned_preemptions(mission))
    fmt::print("{}: plan {} gives way to {}\n", each.subsystem, each.plan, fmt::join(each.by, ", "));
  for (const descriptor::MissionLink& link : mission.links) {
    if (link.on_loss == descriptor::OnLoss::Down) continue;
    fmt::print("{} without {} of {}: {}", link.to, link.requires_, link.from, to_text(link.on_loss));
    if (link.on_loss == descriptor::OnLoss::Hold) fmt::print(" {} ms", link.hold / 1ms);
    fmt::print("{}{}\n", link.fallback.empty() ? "" : " to ", link.fallback);
  }
}

/// What was found, each once, however many missions name a file.
class Findings {
 public:
  explicit Findings(const CheckOptions& options) : options_{options} {}

  [[nodiscard]] descriptor::FileSource counting() {
    return [this](const std::filesystem::path& file) -> Result<std::string> {
      files_.insert(file.lexically_normal());
      return source_(file);
    };
  }

  void add(std::vector<descriptor::Diagnostic> found) {
    for (auto& problem : found) {
      if (!seen_.emplace(problem.file.lexically_normal(), problem.at.line, problem.at.column, problem.message).second)
        continue;
      ++(problem.grade == descriptor::Grade::Error ? errors_ : warnings_);
      show(problem);
    }
  }

  [[nodiscard]] std::size_t errors() const noexcept { return errors_; }

  void sum_up() const {
    if (options_.json) return;
    const auto counted = [](std::size_t count, std::string_view what) {
      return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
    };
    const std::string files = counted(files_.size(), "file"), warnings = counted(warnings_, "warning");
    if (errors_ == 0 && warnings_ == 0) fmt::print("{}, no problem\n", files);
    else if (errors_ == 0) fmt::print("{}, no error, {}\n", files, warnings);
    else
      fmt::print(stderr, "{}, {}, {}; codes are explained in {}\n", files, counted(errors_, "error"), warnings,
                 document("descriptor-errors.md"));
  }

 private:
  void show(const descriptor::Diagnostic& problem) const {
    if (options_.json)
      fmt::print("{}\n", json_line({{"file", problem.file.string()},
                                    {"line", problem.at.line},
                                    {"column", problem.at.column},
                                    {"grade", problem.grade == descriptor::Grade::Error ? "error" : "warning"},
                                    {"code", problem.code},
                                    {"message", problem.message},
                                    {"hint", problem.hint}}));
    else fmt::print(stderr, "{}", descriptor::render(problem, source_, colour_));
  }

  const CheckOptions& options_;
  const descriptor::FileSource source_{descriptor::file_system()};
  const bool colour_{::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr};
  std::set<std::filesystem::path> files_;
  std::set<std::tuple<std::filesystem::path, int, int, std::string>> seen_;
  std::size_t errors_{0};
  std::size_t warnings_{0};
};

void check_file(const std::filesystem::path& file, const CheckOptions& options, Findings& findings) {
  const auto source = findings.counting();
  const auto text = source(file);
  if (!text || !is_mission(*text)) {
    auto reading = descriptor::read_subsystem(file, source);
    if (options.show && reading.value) show_subsystem(*reading.value);
    if (reading.value) findings.add(script_problems(*reading.value, source));
    findings.add(std::move(reading.problems));
    return findings.add(std::move(reading.warnings));
  }
  auto reading = descriptor::read_mission(file, source);
  if (options.show && reading.value) show_mission(*reading.value);
  if (options.recovery && reading.value) show_recovery(*reading.value);
  findings.add(std::move(reading.problems));
  findings.add(std::move(reading.warnings));
  if (!reading.value) return;
  findings.add(permit_problems(*reading.value));
  for (const auto& member : reading.value->subsystems) findings.add(script_problems(member.subsystem, source));
  auto missing = unready(*reading.value, FlownAs::Processes);
  for (auto& problem : core_problems(*reading.value, ProcessorSet::of_this_thread()))
    missing.push_back(std::move(problem));
  for (auto& problem : missing)
    if ((problem.code == "E0401" || problem.code == "E0423" || problem.code == "E0364" || problem.code == "E0365" ||
         problem.code == "E0368") &&
        !options.fly)
      problem.grade = descriptor::Grade::Warning;
  findings.add(std::move(missing));
  findings.add(unlikely(*reading.value));
  findings.add(unisolated(*reading.value));
  if (!options.fly) return;
  findings.add(unloadable(*reading.value));
  findings.add(unintroduced(*reading.value));
}

}  // namespace

int check(const CheckOptions& options) {
  Findings findings{options};
  for (const std::string& name : options.files) {
    const auto file = find_mission(name);
    check_file(file.empty() ? std::filesystem::path{name} : file, options, findings);
  }
  findings.sum_up();
  return findings.errors() == 0 ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
