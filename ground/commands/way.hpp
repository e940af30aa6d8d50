// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco::ground {

/// How a telecommand leaves: behind those that wait for the link, or by a connection of its own to the port that is for
/// telecommands alone, past a link that takes nothing (docs/adr/0028).
enum class Way : std::uint8_t { InTurn, Alone };

}  // namespace hirosco::ground
