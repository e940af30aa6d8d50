// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "hirosco/descriptor/mission.hpp"

namespace hirosco::descriptor {

std::string to_string(const Override& changed) {
  return fmt::format("{}={}", changed.parameter, fmt::join(changed.values, " "));
}

Result<> apply_override(Subsystem& subsystem, std::string_view text) {
  const std::string_view name = text.substr(0, text.find('='));
  const auto parameter =
      std::ranges::find_if(subsystem.parameters, [&](const Parameter& p) { return p.field.name == name; });
  if (parameter == subsystem.parameters.end()) return fail(ErrorCode::NotFound, "no such parameter");
  std::vector<double> values;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data() + name.size(); at != end;) {
    double value = 0;
    const auto read = std::from_chars(at + 1, end, value);  // behind '=' or the space
    if (read.ec != std::errc{}) return fail(ErrorCode::OutOfRange, "not a number");
    values.push_back(value);
    at = read.ptr;
  }
  if (values.size() != parameter->field.count) return fail(ErrorCode::OutOfRange, "another number of values");
  parameter->init = std::move(values);
  return ok();
}

}  // namespace hirosco::descriptor
