// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/serial_line.hpp"
#include "hirosco/descriptor/read/detail/device_addresses.hpp"
#include "hirosco/descriptor/read/detail/device_reader.hpp"

/// Where devices are: the form of their addresses, whose each is, and what a mission permits beyond this computer (docs/adr/0112).
namespace hirosco::descriptor::detail {
namespace {

constexpr std::size_t longest_name = 64;

[[nodiscard]] bool is_plain(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

[[nodiscard]] bool is_plain_name(std::string_view text) noexcept {
  return !text.empty() && text.size() <= longest_name && text.front() != '.' && std::ranges::all_of(text, is_plain);
}

/// Of a file below /dev, without a way out of it.
[[nodiscard]] bool is_device_file(std::string_view text) noexcept {
  constexpr std::string_view devices = "/dev/";
  if (!text.starts_with(devices)) return false;
  text.remove_prefix(devices.size());
  const auto in_path = [](char c) { return is_plain(c) || c == '/' || c == ':'; };
  return !text.empty() && text.size() <= longest_name && text.front() != '/' && text.find("..") == text.npos &&
         std::ranges::all_of(text, in_path);
}

}  // namespace

std::string refuse_address(AddressForm form, const std::string& address) {
  switch (form) {
    case AddressForm::HostPort:
      return classify_address(address) == Address::Malformed ? "host:port is needed, for example 127.0.0.1:5000" : "";
    case AddressForm::Name:
      return is_plain_name(address) ? "" : "a name of 1 to 64 letters, digits, '_', '-' and '.' is needed, no path";
    case AddressForm::Line: {
      const std::string path = address.substr(0, address.rfind('@'));
      if (!is_plain_name(path) && !is_device_file(path))
        return "a file below /dev, or the name of a pseudo-terminal, is needed: /dev/ttyUSB0@115200";
      return read_serial_line(address) ? "" : "no line has this speed: 9600, 115200, 1000000, ...";
    }
  }
  return "";
}

void DeviceAddresses::read_device_network(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* address = attributes.required("address");
  const auto* interface = attributes.optional("interface");
  if (address == nullptr) return;
  const auto refuse = [&](const char* why) {
    problems_.add(*address, "E0347", fmt::format("{} is no network for devices: {}", in_quotes(address->value), why),
                  "address/prefix, for example 192.0.2.0/24 or 2001:db8::/64, and in 'interface' the name of one");
  };
  if (address->value.find('%') != std::string::npos) return refuse("an interface has an attribute of its own");
  auto network = hirosco::read_device_network(address->value + (interface != nullptr ? "%" + interface->value : ""));
  if (!network) return refuse(network.error().text);
  if (std::ranges::find(mission_.device_networks, *network) != mission_.device_networks.end())
    return refuse("it is named already");
  mission_.device_networks.push_back(std::move(*network));
}

void DeviceAddresses::check_endnodes(const SubsystemDescriptor& subsystem) {
  Problems problems{subsystem.file};
  for (const Device& device : subsystem.devices)
    if (device.enable) {
      check_endnode(*device.enable, subsystem.name, problems);
      for (const Endnode& other : device.enable_terms.fall_backs) check_endnode(other, subsystem.name, problems);
    }
  for (const PowerSwitch& power : subsystem.power_switches) {
    check_endnode(power.endnode, subsystem.name, problems);
    for (const Endnode& other : power.terms.fall_backs) check_endnode(other, subsystem.name, problems);
  }
  for (const Configuration& configuration : subsystem.configurations)
    for (const DeviceUse& use : configuration.devices) {
      check_endnode(use.endnode, subsystem.name, problems);
      for (const Endnode& other : use.fall_backs) check_endnode(other, subsystem.name, problems);
    }
  if (problems.count() != 0) draft_.subsystem_problems.push_back(problems.take());
}

namespace {

void check_reach_of(const Endnode& endnode, const std::vector<DeviceNetwork>& permitted, Problems& problems) {
  const auto address = read_device_address(endnode.address);
  if (!address)
    return problems.add(
        endnode.at, "E0313",
        fmt::format("{} is no address of one device: {}", in_quotes(endnode.address), address.error().text),
        "numbers are wanted, as what a name means is another computer's word", 8);
  if (address->loopback() || find_network(permitted, *address) != nullptr) return;
  problems.add(endnode.at, "E0313", in_quotes(endnode.address) + " leaves this computer",
               "127.0.0.1, or let the mission name the craft's network: <DeviceNetwork address=\"192.0.2.0/24\"/>", 8);
}

}  // namespace

void DeviceAddresses::check_endnode(const Endnode& endnode, const std::string& subsystem, Problems& problems) {
  const FlowMeans* means = find_flow_means(endnode.transfer);
  if (means == nullptr) return;
  // Of an instance, whose address the mission changes.
  if (std::string wrong = refuse_address(means->form, endnode.address); !wrong.empty())
    return problems.add(endnode.at, "E0217",
                        fmt::format("{} is no address for {}", in_quotes(endnode.address), to_text(endnode.transfer)),
                        std::move(wrong), 8);
  if (means->form == AddressForm::HostPort) check_reach_of(endnode, mission_.device_networks, problems);
  const auto taken = addresses_.try_emplace({endnode.transfer, endnode.address}, subsystem).first;
  if (taken->second != subsystem)
    problems.add(endnode.at, "E0313",
                 fmt::format("{} is a device's of '{}'", in_quotes(endnode.address), taken->second),
                 "each device needs an address of its own", 8);
}

}  // namespace hirosco::descriptor::detail
