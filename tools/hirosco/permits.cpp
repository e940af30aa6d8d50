// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/permits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "hirosco/pus/standard_services.hpp"

namespace hirosco::tools {
namespace {

[[nodiscard]] bool is_a_modes_to_open(const pus::ServiceKind& kind) {
  return std::ranges::any_of(kind.requests, [&](const pus::RequestKind& request) {
    return kind.needs_of(request.subtype) == pus::Needs::Nothing;
  });
}

}  // namespace

std::vector<descriptor::Diagnostic> permit_problems(const descriptor::Mission& mission) {
  std::string known;
  for (const pus::ServiceKind* kind : pus::standard_services())
    if (is_a_modes_to_open(*kind)) known += fmt::format("{} {} ({})", known.empty() ? "" : ",", kind->type, kind->name);
  std::vector<descriptor::Diagnostic> found;
  for (const descriptor::Mode& mode : mission.modes)
    for (const descriptor::Permit& permit : mode.permits)
      for (const std::uint8_t service : permit.services) {
        const pus::ServiceKind* const kind = pus::standard_service(service);
        if (service >= pus::first_custom_service || (kind != nullptr && is_a_modes_to_open(*kind))) continue;
        found.push_back({.file = mission.file,
                         .at = permit.at,
                         .code = "E0352",
                         .message = fmt::format("mode '{}' permits service {}{}", mode.name, service,
                                                kind == nullptr ? ", which nobody has" : ", which no mode opens"),
                         .hint = "a mode opens" + known + ", and services of a subsystem's own"});
      }
  return found;
}

}  // namespace hirosco::tools
