// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
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

/// The same for who must not wait for a disk: what was noted, where that does not answer within `limit` (docs/adr/0192). What it has beyond
/// counts as lost then, and is there all the same.
/// \param find In a thread of its own, which outlives this call where the disk holds it up.
/// Realtime: waits for `limit` at most.
[[nodiscard]] LogResumption resumption_within(Duration limit, LogResumption noted, std::function<LogResumption()> find);

}  // namespace hirosco::supervisor
