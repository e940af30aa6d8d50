// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"
#include "tests/devices/line_protocol.hpp"

/// All ways to a device, as a suite wants them: an address of its own each time, and what plays the device there.
namespace hirosco::testing {

/// What plays the device at one end of a way: by hand, one answer at a time.
class PlayedDevice {
 public:
  virtual ~PlayedDevice() = default;
  /// The value of the newest command that came; empty: none did.
  [[nodiscard]] virtual std::optional<double> hear() = 0;
  enum class Harm : std::uint8_t { None, Damaged, WrongSize };
  /// Says a value in answer to the newest command.
  virtual void say(double value, Harm harm = Harm::None) = 0;
};

struct Way {
  std::string name;
  Framing framing{Framing::Frames};
  /// Another one each time.
  std::function<FlowAddress()> address;
  /// Its own flows: those of the system, or of one process.
  std::function<std::unique_ptr<FlowFactory>()> flows;
};
[[nodiscard]] std::vector<Way> all_ways();
[[nodiscard]] std::unique_ptr<PlayedDevice> play(const Way& way, FlowFactory& flows, const FlowAddress& address);

}  // namespace hirosco::testing
