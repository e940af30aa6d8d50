// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/simulated_inhibit.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/data_transfer/device/device_frame.hpp"

namespace hirosco::simulation {

Result<> SimulatedInhibit::open(FlowFactory& flows) {
  if (!endnode_ || flow_ != nullptr) return ok();
  FlowAddress address = *endnode_;
  address.holder = FlowHolder::Supervisor;
  HIROSCO_TRY_LET(flow_, flows.open(address, FlowSide::Device));
  return ok();
}

void SimulatedInhibit::receive(TimePoint now, bool hears) noexcept {
  if (flow_ == nullptr) return;
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = flow_->receive(buffer);
  if (!received || received->flow != Flow::New || !hears) return;
  const auto command = read_enable_command(Octets{buffer}.first(std::min(received->octets, buffer.size())));
  if (!command) {
    ++damaged_commands_;
    return;
  }
  asked_ = command->sequence;
  // A repetition is no sign of life, and nobody goes back to what was given before.
  if (enable_ && (command->sequence == enable_->sequence || command->epoch < enable_->epoch)) return;
  enable_ = *command;
  until_ = now + limit_;
}

void SimulatedInhibit::answer(bool plugged, EnableStatus status) noexcept {
  const auto asked = std::exchange(asked_, std::nullopt);
  if (!asked || !plugged) return;
  status.sequence = *asked;
  std::array<std::byte, enable_frame_octets> buffer;
  const auto written = write_enable_status(buffer, status);
  // Nobody listening is no matter of a device's.
  if (written) (void)flow_->send(*written);
}

bool SimulatedInhibit::enabled(std::uint32_t epoch, TimePoint now) const noexcept {
  if (!endnode_) return true;
  return enable_ && enable_->enabled == 1 && enable_->epoch == epoch && now < until_;
}

void SimulatedInhibit::forget() noexcept {
  enable_.reset();
  asked_.reset();
}

}  // namespace hirosco::simulation
