// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "hirosco/descriptor/read/detail/device_reader.hpp"
#include "hirosco/descriptor/read/detail/mission_parts.hpp"

namespace hirosco::descriptor::detail {
namespace {

void read_simulated_device(const xml::Element& element, MissionDraft& draft, Unique& names, Unique& played_devices) {
  Attributes attributes{element, draft.problems};
  SimulatedDevice device;
  device.at = place(element.at);
  device.name = attributes.name("name", NameKind::Loose);
  device.executable = attributes.name("executable", NameKind::Loose);
  device.seed = attributes.integer_or<std::uint64_t>("seed", 0, std::numeric_limits<std::int64_t>::max(), 1);
  device.core = read_core(attributes);
  const auto* subsystem = attributes.required("subsystem");
  const auto* played = attributes.required("device");
  if (subsystem != nullptr) device.subsystem = subsystem->value;
  if (played != nullptr) device.device = played->value;
  const SubsystemDescriptor* owner = subsystem == nullptr ? nullptr : draft.find(*subsystem, subsystem->value, false);
  if (owner != nullptr && played != nullptr) {
    std::vector<std::string_view> known;
    // A simulated device plays a whole one, with all its endnodes.
    for (const Device& candidate : owner->devices)
      if (candidate.part_of.empty()) known.push_back(candidate.name);
      else if (known.empty() || known.back() != candidate.part_of) known.push_back(candidate.part_of);
    if (std::ranges::find(known, played->value) == known.end())
      draft.problems.add(*played, "E0312", fmt::format("'{}' has no device {}", owner->name, in_quotes(played->value)),
                         did_you_mean(played->value, known));
    else
      played_devices.add(device.subsystem + "." + device.device, place(played->value_at), draft.problems,
                         played->value.size());
  }
  Unique settings{"setting", "E0201"};
  each_child(
      element, draft.problems,
      {{"Setting", [&](const auto& child) { read_setting(child, draft.problems, settings, device.settings); }, 256}});
  if (!device.name.empty()) names.add(device.name, device.at, draft.problems, element.name.size() + 1);
  draft.mission.devices.push_back(std::move(device));
}

}  // namespace

void read_simulated_devices(const std::vector<const xml::Element*>& elements, MissionDraft& draft) {
  Unique names{"simulated device", "E0201"}, played_devices{"device", "E0201"};
  for (const auto* element : elements) read_simulated_device(*element, draft, names, played_devices);
}

}  // namespace hirosco::descriptor::detail
