// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/pinged_time.hpp"

#include <algorithm>

namespace hirosco::campaign {
namespace {

constexpr Duration ping_every = 250ms;

}  // namespace

void PingedTime::look() {
  if (parts_.defect.each_instant) parts_.defect.each_instant();
  parts_.trace.look();
}

void PingedTime::run_until(Duration since_start) {
  simulation::Spacecraft& craft = parts_.craft;
  const TimePoint end = start_of_flight + since_start;
  while (craft.now() < end && !craft.finished()) {
    const auto since_ping = (craft.now() - start_of_flight) % ping_every;
    const TimePoint next_ping = craft.now() - since_ping + ping_every;
    static_cast<void>(craft.run_until(
        [this] {
          look();
          return false;
        },
        std::min(next_ping, end) - craft.now()));
    look();
    if (craft.now() == next_ping)
      parts_.traffic.send(FlightTraffic::ground,
                          {.apid = parts_.mission.supervisor.id, .service = 17, .subtype = 1, .ack = 15}, {});
  }
}

void PingedTime::run(Duration span) { run_until(parts_.craft.now() - start_of_flight + span); }

void PingedTime::run_until(const std::function<bool()>& condition, Duration limit) {
  const TimePoint end = parts_.craft.now() + limit;
  constexpr Duration look_every = 1ms;
  while (!condition() && parts_.craft.now() < end && !parts_.craft.finished()) run(look_every);
}

}  // namespace hirosco::campaign
