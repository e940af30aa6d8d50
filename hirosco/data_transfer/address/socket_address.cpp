// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/address/socket_address.hpp"

#include <netinet/in.h>

#include <cstring>

namespace hirosco {

SocketAddress socket_address(const InternetAddress& address) noexcept {
  SocketAddress made;
  if (address.family == InternetAddress::Family::Ipv4) {
    sockaddr_in fourth{};
    fourth.sin_family = AF_INET;
    fourth.sin_port = htons(address.port);
    std::memcpy(&fourth.sin_addr, address.octets.data(), sizeof fourth.sin_addr);
    std::memcpy(&made.storage, &fourth, sizeof fourth);
    made.octets = sizeof fourth;
  } else {
    sockaddr_in6 sixth{};
    sixth.sin6_family = AF_INET6;
    sixth.sin6_port = htons(address.port);
    std::memcpy(&sixth.sin6_addr, address.octets.data(), sizeof sixth.sin6_addr);
    std::memcpy(&made.storage, &sixth, sizeof sixth);
    made.octets = sizeof sixth;
  }
  return made;
}

std::optional<InternetAddress> internet_address(const SocketAddress& address) noexcept {
  InternetAddress made;
  if (address.storage.ss_family == AF_INET) {
    sockaddr_in fourth{};
    std::memcpy(&fourth, &address.storage, sizeof fourth);
    made.port = ntohs(fourth.sin_port);
    std::memcpy(made.octets.data(), &fourth.sin_addr, sizeof fourth.sin_addr);
    return made;
  }
  if (address.storage.ss_family != AF_INET6) return std::nullopt;
  sockaddr_in6 sixth{};
  std::memcpy(&sixth, &address.storage, sizeof sixth);
  made.family = InternetAddress::Family::Ipv6;
  made.port = ntohs(sixth.sin6_port);
  std::memcpy(made.octets.data(), &sixth.sin6_addr, sizeof sixth.sin6_addr);
  return made;
}

std::optional<InternetAddress> own_internet_address(int socket) noexcept {
  SocketAddress own;
  own.octets = sizeof own.storage;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&own.storage), &own.octets) != 0) return std::nullopt;
  return internet_address(own);
}

}  // namespace hirosco
