// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace hirosco::ground {

/// Path and decoded parameters of a request's target.
struct Target {
  std::string path;
  std::multimap<std::string, std::string> parameters;
  [[nodiscard]] std::optional<std::string> text(const std::string& name) const;
  [[nodiscard]] std::optional<double> number(const std::string& name) const;
};
/// Empty: broken percent signs or a NUL.
[[nodiscard]] std::optional<Target> read_target(std::string_view target);

}  // namespace hirosco::ground
