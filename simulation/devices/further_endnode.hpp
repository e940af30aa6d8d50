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

namespace hirosco::simulation {

/// An endnode of a simulated device besides the one that drives it: where it is reached.
struct FurtherEndnode {
  std::string name;  ///< as the descriptor calls it within the device
  std::vector<FlowAddress> addresses;  ///< preferred, then fall-backs
  std::endian byte_order{std::endian::little};  ///< of the payload
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
  void answer(Octets payload, std::uint16_t flags) noexcept;
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
