// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "simulation/devices/endnode_ways.hpp"
#include "simulation/devices/obedience.hpp"

namespace hirosco::simulation {

/// What an endnode besides the one that drives its device has of its own where it has an actuator.
struct FurtherActuator {
  DeviceStop stop{DeviceStop::Drop};
  Duration stop_within{0};  ///< of DeviceStop::Controlled
  std::optional<FlowAddress> enable{};  ///< endnode of its second inhibit; none: the subsystem's frames suffice
  std::vector<FlowAddress> enable_fall_backs{};  ///< other ways to that
};

/// An endnode of a simulated device besides the one that drives it: where it is reached.
struct FurtherEndnode {
  std::string name;  ///< as the descriptor calls it within the device
  std::vector<FlowAddress> addresses;  ///< preferred, then fall-backs
  std::endian byte_order{std::endian::little};  ///< of the payload
  std::optional<FurtherActuator> actuator{};  ///< none: it measures, or takes orders that move nothing
};

/// What runs at it: commands are fenced by their epoch, and each is answered once. What they say and what is said is the
/// device's. Realtime: bounded, no allocation. Thread: one.
class FurtherExchange {
 public:
  FurtherExchange(const FurtherEndnode& described, std::unique_ptr<EndnodeWays> ways)
      : name_{described.name}, order_{described.byte_order}, ways_{std::move(ways)} {}
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] std::endian byte_order() const noexcept { return order_; }
  [[nodiscard]] EndnodeWays& ways() noexcept { return *ways_; }
  /// The newest command that came and is not of an epoch before another one; its payload views `buffer`.
  [[nodiscard]] std::optional<DeviceCommand> hear(MutableOctets buffer) noexcept;
  /// To what it has heard.
  void answer(Octets payload, std::uint16_t flags) noexcept {
    answer({.epoch = epoch_, .sequence = sequence_, .flags = flags, .payload = payload});
  }
  void answer(const DeviceStatus& status) noexcept;
  /// It has had no power: it knows nothing of what was before.
  void forget() noexcept { epoch_ = sequence_ = 0; }

 private:
  std::string name_;
  std::endian order_;
  std::unique_ptr<EndnodeWays> ways_;
  std::uint32_t epoch_{0};
  std::uint32_t sequence_{0};
};

}  // namespace hirosco::simulation
