// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// A network on which a flight's devices may be reached, as its mission names it (docs/adr/0112). Everything else that leaves
/// this computer is refused.
struct DeviceNetwork {
  InternetAddress network;  ///< the bits behind the prefix are 0; port 0
  std::uint8_t prefix{0};  ///< bits, at least 8
  std::string interface;  ///< by which alone it is reached; empty: any that has an address of the network
  [[nodiscard]] bool contains(const InternetAddress& address) const noexcept;
  friend bool operator==(const DeviceNetwork&, const DeviceNetwork&) = default;
};

/// "192.0.2.0/24", "2001:db8::/64", behind it "%eth1" where it has an interface. InvalidArgument: not of this form, bits behind the
/// prefix, a prefix below 8, or a network of loopback, which needs no leave.
[[nodiscard]] Result<DeviceNetwork> read_device_network(std::string_view text);
[[nodiscard]] std::string to_text(const DeviceNetwork& network);

/// Words with blanks between them, as the environment of a flight has them. What is no network is left out: nothing is permitted by it.
[[nodiscard]] std::vector<DeviceNetwork> read_device_networks(std::string_view text);
[[nodiscard]] std::string words_of(std::span<const DeviceNetwork> networks);

/// Null: in none of them.
[[nodiscard]] const DeviceNetwork* find_network(std::span<const DeviceNetwork> networks,
                                                const InternetAddress& address) noexcept;

/// "host:port" of a device: an IPv4 or IPv6 literal (the latter in brackets), or "localhost". InvalidArgument: not of this form.
[[nodiscard]] Result<InternetAddress> read_device_address(std::string_view text);

}  // namespace hirosco
