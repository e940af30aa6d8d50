// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hirosco/xml/reader.hpp"

namespace hirosco::tools {

/// What the value of an attribute is to be, escaped as in the file.
struct OtherValue {
  xml::Position value_at;  ///< as the reader has it
  std::string value;
};
/// A text that was read, with other values; every other octet stays.
[[nodiscard]] std::string with_values(std::string_view text, const std::vector<OtherValue>& values);

}  // namespace hirosco::tools
