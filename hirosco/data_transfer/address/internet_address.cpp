// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/address/internet_address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>

namespace hirosco {
namespace {

std::uint8_t octet(const InternetAddress& address, std::size_t at) {
  return std::to_integer<std::uint8_t>(address.octets[at]);
}

bool is_all_zero(const InternetAddress& address, std::size_t first, std::size_t end) {
  return std::all_of(address.octets.begin() + static_cast<std::ptrdiff_t>(first),
                     address.octets.begin() + static_cast<std::ptrdiff_t>(end),
                     [](std::byte each) { return each == std::byte{0}; });
}

/// Of one end alone: a datagram to it has one receiver, wherever it is read.
bool is_of_one_end(const InternetAddress& address) {
  if (address.family == InternetAddress::Family::Ipv4) {
    const std::uint8_t first = octet(address, 0);
    return first != 0 && first < 224;  // "this network"; multicast, reserved and broadcast
  }
  const bool link_local =
      octet(address, 0) == 0xFE && (octet(address, 1) & 0xC0U) == 0x80;  // means nothing without its interface
  const bool mapped = is_all_zero(address, 0, 10) && octet(address, 10) == 0xFF && octet(address, 11) == 0xFF;
  return octet(address, 0) != 0xFF && !link_local && !mapped && !is_all_zero(address, 0, 16);
}

}  // namespace

bool InternetAddress::loopback() const noexcept {
  if (family == Family::Ipv4) return octet(*this, 0) == 127;
  return is_all_zero(*this, 0, 15) && octet(*this, 15) == 1;
}

Result<InternetAddress> read_internet_address(std::string_view text) {
  InternetAddress address;
  std::string_view host = text, port;
  const bool in_brackets = text.starts_with('[');
  if (in_brackets) {
    const std::size_t end = text.find("]:");
    if (end == std::string_view::npos) return fail(ErrorCode::InvalidArgument, "an address in brackets has a port");
    host = text.substr(1, end - 1);
    port = text.substr(end + 2);
  } else if (std::ranges::count(text, ':') == 1) {
    host = text.substr(0, text.find(':'));
    port = text.substr(host.size() + 1);
  }
  const std::string literal{host};
  if (literal.find('\0') != std::string::npos) return fail(ErrorCode::InvalidArgument, "not an address");
  const bool sixth = literal.find(':') != std::string::npos;
  if (sixth) address.family = InternetAddress::Family::Ipv6;
  if (in_brackets && !sixth) return fail(ErrorCode::InvalidArgument, "only an IPv6 address stands in brackets");
  if (::inet_pton(sixth ? AF_INET6 : AF_INET, literal.c_str(), address.octets.data()) != 1)
    return fail(ErrorCode::InvalidArgument, "not an IPv4 or IPv6 address");
  if (host.size() != text.size()) {
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error != std::errc{} || end != port.data() + port.size() || address.port == 0)
      return fail(ErrorCode::InvalidArgument, "port is not 1 .. 65535");
  }
  if (!is_of_one_end(address)) return fail(ErrorCode::InvalidArgument, "an address that is not of one end alone");
  return address;
}

std::string to_text(const InternetAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const bool sixth = address.family == InternetAddress::Family::Ipv6;
  if (::inet_ntop(sixth ? AF_INET6 : AF_INET, address.octets.data(), text.data(), text.size()) == nullptr) return {};
  const std::string host{text.data()};
  if (address.port == 0) return host;
  return (sixth ? "[" + host + "]" : host) + ":" + std::to_string(address.port);
}

}  // namespace hirosco
