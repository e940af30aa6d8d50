// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "supervisor/platform/storage/packet_log.hpp"

namespace hirosco::supervisor {

/// Nothing flies whose telecommands nobody could find again: the first record must reach the disk within `limit`, whatever
/// the store meets and heals meanwhile. Empty when it did, else why not.  Realtime: blocks.
[[nodiscard]] std::optional<std::string> begin_log(ThreadedPacketLog& log, const Clock& clock, Duration limit);

}  // namespace hirosco::supervisor
