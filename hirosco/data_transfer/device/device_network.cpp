// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_network.hpp"

#include <algorithm>
#include <charconv>

namespace hirosco {
namespace {

constexpr std::uint8_t least_prefix = 8;
constexpr std::size_t longest_interface = 15;  // what an operating system names one by

[[nodiscard]] std::uint8_t bits_of(InternetAddress::Family family) noexcept {
  return family == InternetAddress::Family::Ipv4 ? 32 : 128;
}

/// The bits of one octet that belong to the prefix.
[[nodiscard]] std::byte mask_at(std::size_t octet, std::uint8_t prefix) noexcept {
  const std::size_t first = octet * 8;
  if (prefix >= first + 8) return std::byte{0xFF};
  if (prefix <= first) return std::byte{0};
  return static_cast<std::byte>(0xFF << (8 - (prefix - first)));
}

[[nodiscard]] bool is_interface(std::string_view text) noexcept {
  return !text.empty() && text.size() <= longest_interface && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
}

}  // namespace

bool DeviceNetwork::contains(const InternetAddress& address) const noexcept {
  if (address.family != network.family) return false;
  for (std::size_t i = 0; i < network.octets.size(); ++i)
    if ((address.octets[i] & mask_at(i, prefix)) != network.octets[i]) return false;
  return true;
}

Result<DeviceNetwork> read_device_network(std::string_view text) {
  DeviceNetwork made;
  if (const auto percent = text.find('%'); percent != text.npos) {
    if (!is_interface(text.substr(percent + 1))) return fail(ErrorCode::InvalidArgument, "no name of an interface");
    made.interface = text.substr(percent + 1);
    text = text.substr(0, percent);
  }
  const auto slash = text.find('/');
  if (slash == text.npos) return fail(ErrorCode::InvalidArgument, "network/prefix is needed");
  HIROSCO_TRY_LET(made.network, read_internet_address(text.substr(0, slash)));
  const std::string_view prefix = text.substr(slash + 1);
  const auto [end, error] = std::from_chars(prefix.data(), prefix.data() + prefix.size(), made.prefix);
  if (made.network.port != 0 || error != std::errc{} || end != prefix.data() + prefix.size())
    return fail(ErrorCode::InvalidArgument, "network/prefix is needed");
  if (made.prefix < least_prefix || made.prefix > bits_of(made.network.family))
    return fail(ErrorCode::InvalidArgument, "the prefix is 8 to 32 bits, of IPv6 8 to 128", made.prefix);
  if (made.network.loopback()) return fail(ErrorCode::InvalidArgument, "addresses of this computer need no leave");
  if (!made.contains(made.network)) return fail(ErrorCode::InvalidArgument, "bits behind the prefix are not 0");
  return made;
}

std::string to_text(const DeviceNetwork& network) {
  std::string text = to_text(network.network) + "/" + std::to_string(network.prefix);
  return network.interface.empty() ? text : text + "%" + network.interface;
}

std::vector<DeviceNetwork> read_device_networks(std::string_view text) {
  std::vector<DeviceNetwork> found;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    if (auto network = read_device_network(word)) found.push_back(std::move(*network));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return found;
}

std::string words_of(std::span<const DeviceNetwork> networks) {
  std::string text;
  for (const DeviceNetwork& network : networks) text += (text.empty() ? "" : " ") + to_text(network);
  return text;
}

const DeviceNetwork* find_network(std::span<const DeviceNetwork> networks, const InternetAddress& address) noexcept {
  const auto found = std::ranges::find_if(networks, [&](const auto& each) { return each.contains(address); });
  return found != networks.end() ? &*found : nullptr;
}

Result<InternetAddress> read_device_address(std::string_view text) {
  constexpr std::string_view local = "localhost:";
  const std::string in_numbers =
      text.starts_with(local) ? "127.0.0.1:" + std::string{text.substr(local.size())} : std::string{text};
  HIROSCO_TRY_LET(const InternetAddress address, read_internet_address(in_numbers));
  if (address.port == 0) return fail(ErrorCode::InvalidArgument, "address is not host:port");
  return address;
}

}  // namespace hirosco
