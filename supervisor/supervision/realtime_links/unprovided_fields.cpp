// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/unprovided_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace hirosco::supervisor {
namespace {

using descriptor::Configuration;
using descriptor::Field;
using descriptor::SubsystemDescriptor;

[[nodiscard]] std::vector<Field> provided_by(const SubsystemDescriptor& producer, const std::string& set) {
  std::vector<Field> found;
  for (const Configuration& configuration : producer.configurations)
    for (const descriptor::Provides& provided : configuration.provides) {
      if (provided.name != set) continue;
      found.insert(found.end(), provided.fields.begin(), provided.fields.end());
      for (const descriptor::ParameterRef& each : provided.parameters)
        std::ranges::copy(descriptor::fields_of(producer, each), std::back_inserter(found));
    }
  return found;
}

/// As the two ends go by it when the link is made.
[[nodiscard]] bool is_among(const std::vector<Field>& provided, const Field& wanted) {
  return std::ranges::any_of(provided, [&](const Field& each) {
    return each.name == wanted.name && each.type == wanted.type && each.count == wanted.count;
  });
}

}  // namespace

std::vector<std::string> unprovided_fields(const descriptor::Mission& mission, const SubsystemDescriptor& producer) {
  std::vector<std::string> lines;
  for (const auto& link : mission.links) {
    const auto consumer = std::ranges::find(mission.subsystems, link.to,
                                            [](const auto& each) -> const auto& { return each.subsystem.name; });
    if (link.from != producer.name || consumer == mission.subsystems.end()) continue;
    const std::vector<Field> provided = provided_by(producer, link.provides);
    for (const Configuration& configuration : consumer->subsystem.configurations)
      for (const descriptor::Requires& wanted : configuration.requires_)
        for (const Field& field : wanted.fields) {
          if (wanted.name != link.requires_ || is_among(provided, field)) continue;
          std::string line =
              fmt::format("{} reads {} of {}.{} (link {})", link.to, field.name, link.from, link.provides, link.id);
          if (std::ranges::find(lines, line) == lines.end()) lines.push_back(std::move(line));
        }
  }
  return lines;
}

}  // namespace hirosco::supervisor
