// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Where an end of a link that travels by a network stands. No names: what a name means is another computer's word.
struct InternetAddress {
  enum class Family : std::uint8_t { Ipv4 = 4, Ipv6 = 6 };
  Family family{Family::Ipv4};
  std::array<std::byte, 16> octets{};  ///< of IPv4 the first four
  std::uint16_t port{0};  ///< 0: the system chooses one
  /// Stays in this computer: 127.0.0.0/8, ::1.
  [[nodiscard]] bool loopback() const noexcept;
  [[nodiscard]] bool same_host(const InternetAddress& other) const noexcept {
    return family == other.family && octets == other.octets;
  }
  friend bool operator==(const InternetAddress&, const InternetAddress&) = default;
};

/// "192.0.2.7", "192.0.2.7:4000", "2001:db8::7" or "[2001:db8::7]:4000". InvalidArgument: not of this form, port 0, or an
/// address that is nobody's in particular (any, broadcast, multicast, of one cable only).
[[nodiscard]] Result<InternetAddress> read_internet_address(std::string_view text);
/// With its port, but 0.
[[nodiscard]] std::string to_text(const InternetAddress& address);

}  // namespace hirosco
