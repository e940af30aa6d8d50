// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/simulated_switch.hpp"

#include <array>
#include <utility>

namespace hirosco::simulation {

Result<> SimulatedSwitch::open(FlowFactory& flows) {
  if (!endnode_ || opened()) return ok();
  std::vector<FlowAddress> addresses{*endnode_};
  addresses.insert(addresses.end(), fall_backs_.begin(), fall_backs_.end());
  for (FlowAddress& address : addresses) address.holder = FlowHolder::Supervisor;
  HIROSCO_TRY_LET(ways_, EndnodeWays::open(flows, std::move(addresses)));
  return ok();
}

bool SimulatedSwitch::step(TimePoint now) noexcept {
  if (!opened()) return false;
  const bool had = on_;
  if (on_ && now >= until_) on_ = false;
  for (std::size_t way = 0; way < ways_->count(); ++way) take(way, now);
  return on_ != had;
}

void SimulatedSwitch::take(std::size_t way, TimePoint now) noexcept {
  std::array<std::byte, max_frame_octets> buffer;
  const auto received = ways_->receive_by(way, buffer);
  if (!received || received->flow != Flow::New) return;
  const auto command = read_power_command(Octets{buffer}.first(received->octets));
  if (!command) return;
  // What comes late by one way takes back nothing that another one has said since; when nobody has told it for so long that it would be off, it
  // knows no number any more.
  const bool forgotten = now >= until_;
  const auto ahead = static_cast<std::int32_t>(command->sequence - sequence_);
  if (way != told_by_ && ahead < 0 && !forgotten) return;
  // A repetition is no sign of life; the same command by another way is the same.
  if (ahead != 0) {
    on_ = command->on;
    until_ = now + command->off_after;
  }
  sequence_ = command->sequence;
  told_by_ = way;
  std::array<std::byte, power_frame_octets> answer;
  // Nobody listening is no matter of a switch's.
  if (const auto status = write_power_status(answer, {.on = on_, .sequence = sequence_}))
    static_cast<void>(ways_->send_by(way, *status));
}

}  // namespace hirosco::simulation
