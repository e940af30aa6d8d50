// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco {

/// Why the framework inhibits the actuators of a subsystem in its own cycle; bits of VitalPage::inhibited. What else stops one: docs/safety/stops.md.
enum Inhibition : std::uint32_t {
  inhibited_by_stop = 1,  ///< stop flag of the permit page, or another epoch
  inhibited_by_link = 2,  ///< a required link is stale or its producer reports a fault
  inhibited_by_device = 4,  ///< a device is silent
  inhibited_by_author = 8,  ///< the subsystem itself (a limit)
  inhibited_by_failure = 16,  ///< a state's node failed, or its output jumped at a bumpless change
  inhibited_by_supervisor = 32,  ///< the supervisor is gone
  inhibited_while_awaited =
      64,  ///< a device or its fall-back has not answered yet, a slower producer has sent no good sample yet; passes by itself
};

}  // namespace hirosco
