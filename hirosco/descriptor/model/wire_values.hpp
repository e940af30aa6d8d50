// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco::descriptor {

/// The value of a field from its octets on the wire (big-endian, packed), if a telecommand could set it now: its length, each number
/// finite and within the range, a BOOL 0 or 1, a TEXT in UTF-8 with zeros behind. Empty otherwise.  Realtime: allocates.
[[nodiscard]] std::optional<std::vector<Value>> values_within(const Field& field, Octets big_endian);

/// The same of a whole parameter: all values of a structure in order.  Realtime: allocates.
[[nodiscard]] std::optional<std::vector<Value>> values_within(const Parameter& parameter, Octets big_endian);

}  // namespace hirosco::descriptor
