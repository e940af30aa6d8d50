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
/// Of a TC[8,1]; empty: it is too short for a name.
[[nodiscard]] std::optional<CalledFunction> function_of_call(const pus::TelecommandView& telecommand);
/// Empty: it is no TC[8,1] either.
[[nodiscard]] inline std::optional<CalledFunction> called_function(const pus::TelecommandView& telecommand) {
  const bool calls = telecommand.service() == 8 && telecommand.subtype() == 1;
  return calls ? function_of_call(telecommand) : std::nullopt;
}

}  // namespace hirosco::supervisor
