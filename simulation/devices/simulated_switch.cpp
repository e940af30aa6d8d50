// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/simulated_switch.hpp"

#include <array>

namespace hirosco::simulation {

Result<> SimulatedSwitch::open(FlowFactory& flows) {
  if (!endnode_ || opened()) return ok();
  FlowAddress address = *endnode_;
  address.holder = FlowHolder::Supervisor;
  HIROSCO_TRY_LET(flow_, flows.open(address, FlowSide::Device));
  return ok();
}

bool SimulatedSwitch::step(TimePoint now) noexcept {
  if (!opened()) return false;
  const bool had = on_;
  take(now);
  return on_ != had;
}

void SimulatedSwitch::take(TimePoint now) noexcept {
  if (on_ && now >= until_) on_ = false;
  std::array<std::byte, max_frame_octets> buffer;
  const auto received = flow_->receive(buffer);
  if (!received || received->flow != Flow::New) return;
  const auto command = read_power_command(Octets{buffer}.first(received->octets));
  if (!command) return;
  // A repetition is no sign of life.
  if (command->sequence != sequence_) {
    on_ = command->on;
    until_ = now + command->off_after;
  }
  sequence_ = command->sequence;
  std::array<std::byte, power_frame_octets> answer;
  // Nobody listening is no matter of a switch's.
  if (const auto status = write_power_status(answer, {.on = on_, .sequence = sequence_}))
    static_cast<void>(flow_->send(*status));
}

}  // namespace hirosco::simulation
