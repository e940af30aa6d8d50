// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::supervisor {

/// The function of TC[8,1] and its first argument, as far as they can be read; for logs and decisions.
struct CalledFunction {
  std::string_view name;  ///< views the telecommand
  std::optional<std::uint8_t> first_argument;
};
[[nodiscard]] std::optional<CalledFunction> called_function(const pus::TelecommandView& telecommand);

}  // namespace hirosco::supervisor
