// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/core_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "hirosco/descriptor/model/cores.hpp"
#include "hirosco/descriptor/model/response_time.hpp"

namespace hirosco::tools {
namespace {

using descriptor::Diagnostic;

constexpr double rounding = 1e-9;

[[nodiscard]] std::optional<std::uint16_t> shared_in(const ProcessorSet& processors) {
  const auto last = processors.last();
  return last ? std::optional{static_cast<std::uint16_t>(*last)} : std::nullopt;
}

[[nodiscard]] const CoreUse* use_of(const std::vector<CoreUse>& uses, std::optional<std::uint16_t> core) {
  const auto found = std::ranges::find(uses, core, &CoreUse::core);
  return found != uses.end() ? &*found : nullptr;
}

[[nodiscard]] CoreUse& claim(std::vector<CoreUse>& uses, std::optional<std::uint16_t> core) {
  const auto found = std::ranges::find(uses, core, &CoreUse::core);
  return found != uses.end() ? *found : uses.emplace_back(CoreUse{.core = core});
}

[[nodiscard]] ProcessorSet beside_lone(const descriptor::Mission& mission, ProcessorSet here) {
  for (const std::uint16_t core : descriptor::lone_cores(mission)) here.remove(core);
  return here;
}

/// What is said of the places of a mission.
class CoreFindings {
 public:
  CoreFindings(const descriptor::Mission& mission, const ProcessorSet& here) : mission_{mission}, here_{here} {}

  void claimed(std::span<const std::uint16_t> cores, const std::string& by, descriptor::Location at) {
    for (const std::uint16_t core : cores)
      if (!here_.has(core))
        add(at, fmt::format("{} is to have core {}, and this computer has none of this number for us", by, core),
            fmt::format("here are: {}", to_string(here_)));
  }
  /// Who names none may be where somebody else is, here.
  void in_time(const descriptor::Mode& mode) {
    for (const auto& [core, share] : core_shares(mission_, mode))
      if (share > 1 + rounding)
        return add(mode.at,
                   fmt::format("here the cycles of mode '{}' take {:.0f} % of {}", mode.name, 100 * share,
                               descriptor::core_words(core)),
                   who_names_none(core));
    for (const descriptor::CycleResponse& cycle : cycle_responses_around(mission_, mode))
      if (!cycle.longest)
        return add(mode.at,
                   fmt::format("here, in mode '{}', {} '{}' may not end in time on {}", mode.name, cycle.subsystem,
                               cycle.name(), descriptor::core_words(cycle.core)),
                   who_names_none(cycle.core));
  }
  void add(descriptor::Location at, std::string message, std::string hint) {
    found_.push_back({mission_.file, at, "E0423", std::move(message), std::move(hint), 1});
  }
  [[nodiscard]] std::vector<Diagnostic> take() { return std::move(found_); }

 private:
  [[nodiscard]] std::string who_names_none(std::optional<std::uint16_t> core) const {
    return core == mission_.shared_core ? "who names no core is there, too: give somebody another one" : "";
  }

  const descriptor::Mission& mission_;
  const ProcessorSet& here_;
  std::vector<Diagnostic> found_;
};

}  // namespace

std::vector<CoreUse> FlightCores::uses() const {
  std::vector<CoreUse> all = named;
  claim(all, shared_in(processors)).load += shared_load;
  return all;
}

FlightCores flight_cores(const descriptor::Mission& mission, const ProcessorSet& here) {
  FlightCores cores{.processors = beside_lone(mission, here)};
  for (const auto& [core, load] : core_shares(mission)) {
    if (core) claim(cores.named, core).load = load;
    else cores.shared_load = load;
  }
  for (const auto& member : mission.subsystems)
    if (member.cores.cycle) claim(cores.named, member.cores.cycle).alone |= member.cores.alone;
  for (const auto& device : mission.devices)
    if (device.core) static_cast<void>(claim(cores.named, device.core));
  for (CoreUse& use : cores.named) use.named = true;
  return cores;
}

void keep_off(FlightCores& cores, const std::vector<OtherCores>& others) {
  for (const OtherCores& other : others)
    for (const CoreUse& use : other.uses)
      if (use.alone && use.core) cores.processors.remove(*use.core);
}

std::string judge_cores(const std::vector<CoreUse>& own, const std::vector<OtherCores>& others) {
  for (const CoreUse& use : own) {
    double load = use.load;
    std::string parts;
    for (const OtherCores& other : others) {
      const CoreUse* const theirs = use_of(other.uses, use.core);
      if (theirs == nullptr) continue;
      if (theirs->alone) return fmt::format("{} is {}'s alone", descriptor::core_words(use.core), other.name);
      if (use.alone)
        return fmt::format("{} is to be this flight's alone, and {} is there", descriptor::core_words(use.core),
                           other.name);
      load += theirs->load;
      parts += fmt::format(", {} {:.0f} %", other.name, theirs->load * 100);
    }
    if (load <= 1.0 + rounding) continue;
    return fmt::format(
        "the cycles of all flights need {:.0f} % of the processor that they share{}: this one {:.0f} %{}", load * 100,
        use.named ? " (" + descriptor::core_words(use.core) + ")" : "", use.load * 100, parts);
  }
  return {};
}

std::vector<Diagnostic> core_problems(const descriptor::Mission& mission, const ProcessorSet& here) {
  if (!descriptor::names_cores(mission) || here.count() == 0) return {};
  descriptor::Mission placed = mission;
  const ProcessorSet left = beside_lone(mission, here);
  placed.shared_core = shared_in(left);
  CoreFindings findings{placed, here};
  for (const auto& member : mission.subsystems) {
    const std::string& name = member.subsystem.name;
    if (member.cores.cycle) findings.claimed(std::span{&*member.cores.cycle, 1}, "the cycle of " + name, member.at);
    findings.claimed(member.cores.services, "the service loop of " + name, member.at);
  }
  for (const auto& device : mission.devices)
    if (device.core) findings.claimed(std::span{&*device.core, 1}, "simulated device " + device.name, device.at);
  if (left.count() == 0)
    findings.add(mission.subsystems.front().at, "each core that is here is some subsystem's alone",
                 "the supervisor, service loops and all who name no core need one");
  else
    for (const descriptor::Mode& mode : mission.modes) findings.in_time(mode);
  return findings.take();
}

}  // namespace hirosco::tools
