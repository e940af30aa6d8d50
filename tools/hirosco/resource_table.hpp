// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "tools/hirosco/resource_marks.hpp"

/// What `hirosco resources` prints: a line for each row, no wider than 80 columns.
namespace hirosco::tools {

enum class Flies : std::uint8_t { No, Yes };  ///< Yes: it is told what is taken now, too

[[nodiscard]] std::string resource_heading(Flies flies);
[[nodiscard]] std::string resource_line(const std::string& subsystem, const ResourceRow& row, Flies flies);
/// {subsystem, resource, declared, now where it flies, high, percent}; null is what is not declared or not told.
[[nodiscard]] std::string resource_json(const std::string& subsystem, const ResourceRow& row, Flies flies);

}  // namespace hirosco::tools
