// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/power.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::supervisor {

void PowerSwitches::step(bool on) noexcept {
  const bool changes = on != std::exchange(on_, on);
  std::array<std::byte, max_frame_octets> frame;
  for (Switch& each : switches_) {
    const auto received = each.flow->receive(frame);
    if (received && received->flow == Flow::New) {
      const auto status = read_power_status(Octets{frame}.first(received->octets));
      each.other_version = !status && status.error().code == ErrorCode::Mismatch;
      if (status) each.last = *status;
    }
    if (changes) each.changed_at = each.sequence;
    // A switch that does not hear it is off by itself after a while: that is what it waits for.
    if (const auto written = write_power_command(frame, {.on = on, .sequence = ++each.sequence}))
      static_cast<void>(each.flow->send(*written));
  }
}

Power PowerSwitches::said() const noexcept {
  const auto said = [&](const Switch& each) {
    return each.last.on == on_ && static_cast<std::int32_t>(each.last.sequence - each.changed_at) > 0;
  };
  if (std::ranges::any_of(switches_, &Switch::other_version)) return power_unknown_version;
  if (!std::ranges::all_of(switches_, said)) return power_changes;
  return on_ ? power_on : power_off;
}

}  // namespace hirosco::supervisor
