// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"

namespace hirosco {

/// What an address of a means of transfer is: a name, which belongs to the instance of a flight, or host:port, which is one
/// of the computer's and cannot be had twice.
enum class AddressForm : std::uint8_t { Name, HostPort };

/// One means of transfer of the real set: a function that opens its flows, and a row in `flow_means.cpp`.
struct FlowMeans {
  Transfer transfer;
  AddressForm form;
  Result<std::unique_ptr<DataFlow>> (*open)(const std::string& address, FlowSide side);
};

/// Those that are built in.
[[nodiscard]] std::span<const FlowMeans> standard_flow_means() noexcept;
/// Null: this one is not built in.
[[nodiscard]] const FlowMeans* find_flow_means(Transfer transfer) noexcept;

}  // namespace hirosco
