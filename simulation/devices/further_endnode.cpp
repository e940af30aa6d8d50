// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/further_endnode.hpp"

#include <array>

namespace hirosco::simulation {

std::optional<DeviceCommand> FurtherExchange::hear(MutableOctets buffer) noexcept {
  const auto received = ways_->receive(buffer);
  if (!received || received->flow != Flow::New) return std::nullopt;
  const auto command = read_command(Octets{buffer}.first(received->octets));
  if (!command || command->epoch < epoch_) return std::nullopt;
  epoch_ = command->epoch;
  sequence_ = command->sequence;
  return *command;
}

void FurtherExchange::answer(const DeviceStatus& status) noexcept {
  std::array<std::byte, max_device_frame_octets> frame;
  const auto written = write_status(frame, status);
  // Nobody listening is no matter of a device's.
  if (written) static_cast<void>(ways_->send(*written));
}

}  // namespace hirosco::simulation
