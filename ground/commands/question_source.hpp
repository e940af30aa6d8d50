// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Under which source id a ground station asks the supervisor (ST[129]): another one than that of its telecommands, so that who hears no more
/// than what became of a request knows which of the two it was (ground/api/README.md).
namespace hirosco::ground {

/// Of the station whose telecommands have this one, 0x2000 to 0x3FFF.
[[nodiscard]] constexpr std::uint16_t question_source(std::uint16_t of_telecommands) noexcept {
  return static_cast<std::uint16_t>(of_telecommands | 0xC000U);
}

/// 0xE000 to 0xFFFF: of whichever station.
[[nodiscard]] constexpr bool is_question_source(std::uint16_t source) noexcept { return source >= 0xE000; }

}  // namespace hirosco::ground
