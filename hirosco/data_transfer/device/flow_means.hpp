// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_network.hpp"
#include "hirosco/data_transfer/device/flow_access.hpp"

namespace hirosco {

/// What an address of a means of transfer is: a name, which belongs to the instance of a flight; host:port, which is one of the
/// computer's and cannot be had twice; or a line, which is either: a name or a path below /dev, behind it "@BAUD".
enum class AddressForm : std::uint8_t { Name, HostPort, Line };

/// What is opened.
struct FlowOpening {
  std::string address;  ///< with the flight's instance in it
  FlowSide side{FlowSide::Subsystem};
  Framing framing{Framing::Frames};
  FlowHolder holder{FlowHolder::Subsystem};
  std::span<const DeviceNetwork> networks{};  ///< outside this computer that it may be in
};

/// One means of transfer of the real set: a function that opens its flows, what that needs in a sandbox, and a row in `linux_flow_means.cpp`;
/// what a further one takes besides says `hirosco/data_transfer/README.md`, "To extend".
struct FlowMeans {
  Transfer transfer;
  AddressForm form;
  Result<std::unique_ptr<DataFlow>> (*open)(const FlowOpening& opening);
  FlowAccess access;
};

/// Those that are built in.
[[nodiscard]] std::span<const FlowMeans> standard_flow_means() noexcept;
/// Null: this one is not built in.
[[nodiscard]] const FlowMeans* find_flow_means(Transfer transfer) noexcept;

/// With the flight's instance in it, where it is a name; empty: of a flight that has its mission's name.
[[nodiscard]] std::string address_in_flight(AddressForm form, std::string address, const std::string& instance);

}  // namespace hirosco
