// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <span>

#include "hirosco/descriptor/model/cores.hpp"
#include "hirosco/descriptor/read/detail/mission_parts.hpp"

/// Which cores of the computer a mission gives whom (docs/adr/0234). Whether this computer has them, its reader cannot know.
namespace hirosco::descriptor::detail {
namespace {

std::optional<std::uint16_t> core_in(Attributes& attributes) {
  const auto core = attributes.integer("core", 0, greatest_core);
  return core ? std::optional{static_cast<std::uint16_t>(*core)} : std::nullopt;
}

std::vector<std::uint16_t> cores_in(const xml::Attribute& at, Problems& problems) {
  std::vector<std::uint16_t> cores;
  for (const auto word : words(at.value)) {
    const auto number = to_integer(word);
    if (!number) problems.add(at, "E0111", in_quotes(word) + " is not a number");
    else if (*number < 0 || *number > greatest_core)
      problems.add(at, "E0112", fmt::format("{} is out of range", in_quotes(word)),
                   fmt::format("a core is 0 to {}", greatest_core));
    else if (std::ranges::find(cores, *number) != cores.end())
      problems.add(at, "E0113", in_quotes(word) + " stands twice");
    else cores.push_back(static_cast<std::uint16_t>(*number));
  }
  if (words(at.value).empty()) problems.add(at, "E0109", "attribute '" + at.name + "' is empty");
  return cores;
}

/// A core that is one member's alone, as another claims it.
void check_claim(const xml::Attribute& at, std::span<const std::uint16_t> cores, std::string_view claimant,
                 std::string_view for_whom, const Mission& mission, Problems& problems) {
  for (const MissionSubsystem& owner : mission.subsystems) {
    const std::string& name = owner.subsystem.name;
    if (!owner.cores.alone || !owner.cores.cycle || name == for_whom) continue;
    if (std::ranges::find(cores, *owner.cores.cycle) == cores.end()) continue;
    problems.add(at, "E0379", fmt::format("{} claims core {}, which is {}'s alone", claimant, *owner.cores.cycle, name),
                 fmt::format("another core here, or core_alone=\"no\" for {}", name));
  }
}

}  // namespace

void read_cores(Attributes& attributes, MissionSubsystem& member, Problems& problems) {
  member.cores.cycle = core_in(attributes);
  member.cores.alone = attributes.yes("core_alone", false);
  const auto* services = attributes.optional("service_cores");
  if (services != nullptr) member.cores.services = cores_in(*services, problems);
  if (attributes.element().find("core") != nullptr) return;
  for (const char* const without : {"core_alone", "service_cores"})
    if (const auto* at = attributes.optional(without); at != nullptr && at->value != "no")
      problems.add(*at, "E0378", fmt::format("'{}' of a subsystem that names no core", without),
                   "say core=\"NUMBER\", too: by itself its cycle goes where all do that name none");
}

std::optional<std::uint16_t> read_core(Attributes& attributes) { return core_in(attributes); }

void check_cores(const xml::Element& root, MissionDraft& draft) {
  const Mission& mission = draft.mission;
  const auto claim = [&](const xml::Attribute* at, std::span<const std::uint16_t> cores, std::string_view claimant,
                         std::string_view for_whom) {
    if (at != nullptr) check_claim(*at, cores, claimant, for_whom, mission, draft.problems);
  };
  for (const xml::Element& child : root.children) {
    const auto is_here = [&](const auto& each) { return each.at == place(child.at); };
    if (const auto member = std::ranges::find_if(mission.subsystems, is_here); member != mission.subsystems.end()) {
      const std::string& name = member->subsystem.name;
      if (member->cores.cycle) claim(child.find("core"), std::span{&*member->cores.cycle, 1}, name, name);
      claim(child.find("service_cores"), member->cores.services, name, name);
    }
    // What plays its hardware may be where it is.
    if (const auto device = std::ranges::find_if(mission.devices, is_here);
        device != mission.devices.end() && device->core)
      claim(child.find("core"), std::span{&*device->core, 1}, device->name, device->subsystem);
  }
}

}  // namespace hirosco::descriptor::detail
