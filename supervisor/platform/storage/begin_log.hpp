// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "supervisor/platform/storage/packet_log.hpp"

namespace hirosco::supervisor {

/// The first record: what opens the store, in the thread of the log.
void begin_log(ThreadedPacketLog& log);

/// Nothing flies whose telecommands nobody could find again: the first record must reach the disk within `limit`, whatever
/// the store meets and heals meanwhile. Empty when it did, else why not.  Realtime: blocks.
[[nodiscard]] std::optional<std::string> why_not_begun(ThreadedPacketLog& log, const Clock& clock, Duration limit);

/// A log whose program died, from what that had noted last: more may have reached the disk since. Looks at the two newest pieces.
/// Realtime: blocks.
[[nodiscard]] LogResumption resumption_of(const std::filesystem::path& log, LogResumption noted);

/// The same of one database, as one that is no file has to be asked itself. Empty: it cannot be reached now.
/// Realtime: blocks.
[[nodiscard]] std::optional<LogResumption> resumption_in(Database& database, LogResumption noted,
                                                         std::uint64_t tail_octets = 0);

}  // namespace hirosco::supervisor
