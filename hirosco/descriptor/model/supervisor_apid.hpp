// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco::descriptor {

/// Of the supervisor of every mission, and the source id of its own telecommands (decision 27): members on board reach it without
/// knowing the mission that they fly in.
inline constexpr std::uint16_t supervisor_apid = 1;

}  // namespace hirosco::descriptor
