// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/begin_log.hpp"

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::supervisor {

std::optional<std::string> begin_log(ThreadedPacketLog& log, const Clock& clock, Duration limit) {
  static_cast<void>(log.append({.kind = LogKind::Action, .source = 1, .peer = 1, .packet = {}, .note = "log begins"}));
  const TimePoint end = clock.now() + limit;
  for (;;) {
    // A store in trouble fails the wait at once, and heals by itself if it can.
    if (log.flush(end - clock.now())) return std::nullopt;
    if (clock.now() >= end) break;
    sleep_until(clock.now() + 20ms);
  }
  const StoreTrouble trouble = log.trouble();
  return trouble.present ? trouble.text : "the disk of the log does not answer";
}

}  // namespace hirosco::supervisor
