// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <optional>

#include "hirosco/data_transfer/address/internet_address.hpp"

namespace hirosco {

/// An Internet address as the system has it, for links and devices alike.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t octets{0};
  [[nodiscard]] const sockaddr* get() const noexcept { return reinterpret_cast<const sockaddr*>(&storage); }
};
/// Realtime: bounded. Thread: any.
[[nodiscard]] SocketAddress socket_address(const InternetAddress& address) noexcept;
/// Nothing: it is of another family.  Realtime: bounded. Thread: any.
[[nodiscard]] std::optional<InternetAddress> internet_address(const SocketAddress& address) noexcept;
/// Where a socket stands, with the port that it was given. Nothing: the system does not say, or it is no Internet socket.
/// Realtime: bounded, one system call. Thread: any.
[[nodiscard]] std::optional<InternetAddress> own_internet_address(int socket) noexcept;

}  // namespace hirosco
