// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/simulated_inhibit.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/data_transfer/device/device_frame.hpp"

namespace hirosco::simulation {

Result<> SimulatedInhibit::open(FlowFactory& flows) {
  if (!endnode_ || ways_ != nullptr) return ok();
  std::vector<FlowAddress> addresses{*endnode_};
  addresses.insert(addresses.end(), fall_backs_.begin(), fall_backs_.end());
  for (FlowAddress& address : addresses) address.holder = FlowHolder::Supervisor;
  HIROSCO_TRY_LET(ways_, EndnodeWays::open(flows, std::move(addresses)));
  asked_.resize(ways_->count());
  return ok();
}

void SimulatedInhibit::receive(TimePoint now, bool hears) noexcept {
  for (std::size_t way = 0; way < asked_.size(); ++way) {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = ways_->receive_by(way, buffer);
    if (!received || received->flow != Flow::New || !hears) continue;
    const auto command = read_enable_command(Octets{buffer}.first(std::min(received->octets, buffer.size())));
    if (command) take(*command, way, now);
    else ++damaged_commands_;
  }
}

void SimulatedInhibit::take(const EnableCommand& command, std::size_t way, TimePoint now) noexcept {
  asked_[way] = command.sequence;
  // A repetition is no sign of life, and nobody goes back to what was given before.
  if (enable_ && (command.sequence == enable_->sequence || command.epoch < enable_->epoch)) return;
  // Nor does one way give what was said before by another one, or what that has taken.
  if (enable_ && way != told_by_ && command.enabled == 1 && command.epoch == enable_->epoch) {
    const bool older = static_cast<std::int32_t>(command.sequence - enable_->sequence) < 0;
    if (older || enable_->enabled == 0) return;
  }
  enable_ = command;
  told_by_ = way;
  until_ = now + limit_;
}

void SimulatedInhibit::answer(bool plugged, EnableStatus status) noexcept {
  for (std::size_t way = 0; way < asked_.size(); ++way) {
    const auto asked = std::exchange(asked_[way], std::nullopt);
    if (!asked || !plugged) continue;
    status.sequence = *asked;
    std::array<std::byte, enable_frame_octets> buffer;
    const auto written = write_enable_status(buffer, status);
    // Nobody listening is no matter of a device's.
    if (written) (void)ways_->send_by(way, *written);
  }
}

bool SimulatedInhibit::enabled(std::uint32_t epoch, TimePoint now) const noexcept {
  if (!endnode_) return true;
  return enable_ && enable_->enabled == 1 && enable_->epoch == epoch && now < until_;
}

void SimulatedInhibit::forget() noexcept {
  enable_.reset();
  std::ranges::fill(asked_, std::nullopt);
}

}  // namespace hirosco::simulation
