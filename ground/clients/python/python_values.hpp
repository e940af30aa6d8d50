// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// Values of a descriptor in Python: as a row of a table, as the type of a parameter, and in words.
namespace hirosco::ground {

/// A value as runtime.Field knows it, from a descriptor or from a column.
struct PythonValue {
  descriptor::Field field;
  std::optional<hirosco::Value> fallback;
  std::vector<descriptor::EnumerationText> texts;
  std::size_t offset{0};
  bool fixed{false};  ///< words with zeros behind, as parameters have them
};

/// "_r.Field(...)"
[[nodiscard]] std::string field_call(const PythonValue& value);
[[nodiscard]] std::string fields_tuple(const std::vector<PythonValue>& values);
/// Values and their names.
[[nodiscard]] std::string pairs(const std::vector<descriptor::EnumerationText>& texts);
[[nodiscard]] std::string annotation(const PythonValue& value);
/// "2 x DOUBLE, rad, -2 to 2.6": what may be given, or what comes.
[[nodiscard]] std::string described(const PythonValue& value);

}  // namespace hirosco::ground
