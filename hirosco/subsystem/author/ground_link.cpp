// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/ground_link.hpp"

#include <utility>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

GroundLink::GroundLink(Subsystem& holder, OpenGroundTransport open, OnTaken on_taken)
    : holder_{holder}, open_{std::move(open)}, on_taken_{std::move(on_taken)} {}

Result<> GroundLink::open() {
  if (transport_) return ok();
  HIROSCO_TRY_LET(transport_, open_(*this));
  return ok();
}

void GroundLink::step(TimePoint now) {
  if (!transport_) return;
  look_for_stop();
  transport_->step(now);
}

std::size_t GroundLink::finish(TimePoint now) {
  if (!transport_) return 0;
  look_for_stop();
  return transport_->finish(now);
}

void GroundLink::telemetry(Octets packet) {
  if (transport_) transport_->telemetry(packet);
}

/// Before anything that clients have sent is looked at: what is read behind this and came before it is told from what came later.
void GroundLink::look_for_stop() {
  if (const std::uint32_t newest = holder_.newest_stop(); newest != std::exchange(known_stop_, newest))
    transport_->all_stopped();
}

GroundTraffic::Taken GroundLink::telecommand(ClientId client, Octets packet, Said said) {
  constexpr std::uint32_t nobody_knows = 0;
  // What the supervisor does not take now stays with its client: nothing that was received is lost.
  if (!holder_.submit_ground_telecommand(client, packet, said == Said::Since ? known_stop_ : nobody_knows))
    return Taken::Later;
  if (on_taken_) on_taken_(packet);
  return Taken::Yes;
}

}  // namespace hirosco
