// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

/// Functions of the supervisor that a subsystem may ask for, each as its <Commands> and a permit by its name say; SAFE_ALL by nobody's leave
/// (docs/adr/0216). All others are the ground's alone, whatever descriptor and mission say: they end the flight, let other programs or
/// descriptors fly, move links or raise what safety is reckoned with.
namespace hirosco::descriptor {

inline constexpr std::array<std::string_view, 3> functions_for_subsystems{"ENTER_MODE", "SAFE_ALL", "SET_MODE"};

[[nodiscard]] constexpr bool is_for_subsystems(std::string_view function) noexcept {
  return std::ranges::find(functions_for_subsystems, function) != functions_for_subsystems.end();
}

}  // namespace hirosco::descriptor
