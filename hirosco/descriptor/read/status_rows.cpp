// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/status_rows.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

namespace hirosco::descriptor {
namespace {

[[nodiscard]] std::string lengthen(SubsystemDescriptor& supervisor, std::string_view structure, std::size_t rows) {
  const auto found = std::ranges::find_if(
      supervisor.parameters, [&](const Parameter& parameter) { return parameter.field.name == structure; });
  if (found == supervisor.parameters.end()) return {};
  if (rows > most_status_rows) return fmt::format("{} has {} rows, at most {}", structure, rows, most_status_rows);
  for (auto& column : found->members)
    column.field.count = std::max(column.field.count, static_cast<std::uint32_t>(rows));
  return {};
}

[[nodiscard]] std::size_t octets_of(const SubsystemDescriptor& subsystem, const std::vector<ParameterRef>& references) {
  std::size_t octets = 0;
  for (const ParameterRef& reference : references)
    for (const Field& field : fields_of(subsystem, reference)) octets += field.octets();
  return octets;
}

}  // namespace

std::string give_everybody_a_row(Mission& mission) {
  SubsystemDescriptor& supervisor = mission.supervisor;
  if (auto wrong = lengthen(supervisor, subsystem_rows, mission.subsystems.size() + 1); !wrong.empty()) return wrong;
  if (auto wrong = lengthen(supervisor, link_rows, mission.links.size()); !wrong.empty()) return wrong;
  if (auto wrong = lengthen(supervisor, link_quality_rows, mission.links.size()); !wrong.empty()) return wrong;
  const std::size_t latency_rows = std::min(mission.links.size(), most_latency_rows);
  if (auto wrong = lengthen(supervisor, link_latency_rows, latency_rows); !wrong.empty()) return wrong;
  const auto too_long = [&](const HousekeepingStructure& structure) {
    std::size_t octets = octets_of(supervisor, structure.sampled_once);
    for (const auto& set : structure.sampled_repeatedly)
      octets += set.repetitions * octets_of(supervisor, set.parameters);
    return octets > detail::max_housekeeping_octets ? fmt::format("its report {} takes {} octets, at most {}",
                                                                  structure.id, octets, detail::max_housekeeping_octets)
                                                    : std::string{};
  };
  for (const auto& structure : supervisor.housekeeping)
    if (auto wrong = too_long(structure); !wrong.empty()) return wrong;
  for (const auto& configuration : supervisor.configurations)
    for (const auto& structure : configuration.housekeeping)
      if (auto wrong = too_long(structure); !wrong.empty()) return wrong;
  return {};
}

}  // namespace hirosco::descriptor
