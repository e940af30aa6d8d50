// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/devices/endnode_ways.hpp"
#include "simulation/devices/further_endnode.hpp"
#include "simulation/devices/words.hpp"

namespace hirosco::simulation {

/// The endnodes at which a subsystem meets a simulated device: the one that drives it, and further ones. All of them are plugged in, or
/// none. What runs at them is not looked into here.
/// Realtime: bounded, and does not allocate but in open(), close() and fault(). Thread: one.
class DeviceEndnodes {
 public:
  struct Described {
    FlowAddress address;  ///< of the one that drives the device
    std::vector<FlowAddress> fall_backs{};  ///< other ways to it
    std::string name{};  ///< of it, where the device has several; empty: it has one
    std::vector<FurtherEndnode> further{};
  };
  /// Unplugged. `flows` must outlive it.
  DeviceEndnodes(FlowFactory& flows, Described described) : flows_{flows}, described_{std::move(described)} {}
  DeviceEndnodes(const DeviceEndnodes&) = delete;
  DeviceEndnodes& operator=(const DeviceEndnodes&) = delete;

  /// Opens the device's side of all, or of none.
  [[nodiscard]] Result<> open();
  void close() noexcept;
  [[nodiscard]] bool plugged() const noexcept { return driving_ != nullptr; }
  /// The one that drives the device; null: unplugged.
  [[nodiscard]] DataFlow* driving() noexcept { return driving_.get(); }
  [[nodiscard]] std::span<FurtherExchange> further() noexcept { return further_; }

  /// What came at the one that drives the device. Unavailable: its peer is gone, or it is unplugged.
  [[nodiscard]] Result<Received> receive(MutableOctets buffer) noexcept;
  /// SimulatedDevice::wait().
  [[nodiscard]] bool wait(Duration timeout) noexcept;

  /// way N WHAT | endnode NAME N WHAT: one way fails (EndnodeWays::fault). NotFound: there is none such, or it is unplugged.
  [[nodiscard]] Result<> fault(const Words& words);
  /// Ends what was done to their ways.
  void heal() noexcept;
  /// They have had no power: they know nothing of what was before.
  void forget() noexcept;

 private:
  [[nodiscard]] EndnodeWays* ways_of(std::string_view endnode) noexcept;

  FlowFactory& flows_;
  Described described_;
  std::unique_ptr<EndnodeWays> driving_;
  std::vector<FurtherExchange> further_;
  bool peer_gone_{false};
};

}  // namespace hirosco::simulation
