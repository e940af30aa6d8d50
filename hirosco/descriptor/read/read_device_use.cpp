// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hirosco/descriptor/read/detail/device_reader.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr double max_watchdog_ms = 60'000;

}  // namespace

std::optional<std::uint16_t> DeviceUseReader::find_device(const xml::Element& element, const std::string& name,
                                                          Unique& names) {
  if (name.empty()) return std::nullopt;
  const auto found = std::ranges::find(subsystem_.devices, name, &Device::name);
  if (found == subsystem_.devices.end()) {
    std::vector<std::string_view> known;
    for (const Device& device : subsystem_.devices) known.push_back(device.name);
    problems_.add(*element.find("name"), "E0216", fmt::format("device '{}' is not declared under <Subsystem>", name),
                  did_you_mean(name, known));
    return std::nullopt;
  }
  if (!names.add(name, place(element.at), problems_, element.name.size() + 1)) return std::nullopt;
  return static_cast<std::uint16_t>(found - subsystem_.devices.begin());
}

void DeviceUseReader::read(const xml::Element& element, Configuration& configuration, Unique& names) {
  Attributes attributes{element, problems_};
  DeviceUse use;
  use.at = place(element.at);
  const std::string name = attributes.name("name", NameKind::Loose);
  const bool several =
      !name.empty() && std::ranges::find(subsystem_.devices, name, &Device::part_of) != subsystem_.devices.end();
  read_limits(attributes, use);
  if (several) {
    std::size_t used = 0;
    const auto read_one = [&](const xml::Element& child) {
      ++used;
      read_endnode_use(child, use, name, configuration, names);
    };
    each_child(element, problems_, {{"Endnode", read_one, max_device_endnodes}});
    if (used == 0) problems_.add(element, "E0106", "<Device> in a configuration needs an <Endnode>");
    return;
  }
  if (const auto device = find_device(element, name, names)) use.device = *device;
  check_limits(element, use, configuration.sampling);
  Unique settings{"setting", "E0201"};
  bool connected = false;
  each_child(
      element, problems_,
      {{"Setting", [&](const xml::Element& child) { read_setting(child, problems_, settings, use.settings); }, 256},
       {"Endnode",
        [&](const xml::Element& child) {
          Attributes own{child, problems_};
          read_endnode(own, use);
          each_child(child, problems_,
                     {{"FallBack", [&](const auto& other) { read_fall_back(other, use); }, max_fall_backs}});
          connected = true;
        },
        1}});
  if (!connected) problems_.add(element, "E0106", "<Device> in a configuration needs an <Endnode>");
  check_fall_backs(element, use, configuration.sampling);
  configuration.devices.push_back(std::move(use));
}

/// One of several endnodes of a device; `common` is what its <Device> says for all of them.
void DeviceUseReader::read_endnode_use(const xml::Element& element, const DeviceUse& common, const std::string& device,
                                       Configuration& configuration, Unique& names) {
  Attributes attributes{element, problems_};
  DeviceUse use = common;
  use.at = place(element.at);
  const std::string name = attributes.name();
  if (const auto found = find_device(element, name.empty() ? name : device + "." + name, names)) use.device = *found;
  read_limits(attributes, use);
  check_limits(element, use, configuration.sampling);
  read_endnode(attributes, use);
  Unique settings{"setting", "E0201"};
  each_child(
      element, problems_,
      {{"Setting", [&](const xml::Element& child) { read_setting(child, problems_, settings, use.settings); }, 256},
       {"FallBack", [&](const auto& child) { read_fall_back(child, use); }, max_fall_backs}});
  check_fall_backs(element, use, configuration.sampling);
  configuration.devices.push_back(std::move(use));
}

void DeviceUseReader::read_limits(Attributes& attributes, DeviceUse& use) {
  const xml::Element& element = attributes.element();
  use.silence = read_limit(attributes, "silence", "silence_reduced", use.silence);
  use.every = attributes.integer_or<std::uint32_t>("every", 1, 1'000'000, use.every);
  const auto watchdog = [&](std::string_view attribute, std::uint32_t fallback_us) {
    const auto value_ms = attributes.number(attribute);
    if (!value_ms) return fallback_us;
    if (*value_ms >= 0.001 && *value_ms <= max_watchdog_ms)
      return static_cast<std::uint32_t>(std::lround(*value_ms * 1000));
    problems_.add(*element.find(attribute), "E0112", fmt::format("{} {} is out of range", attribute, *value_ms),
                  "0.001 to 60000 ms");
    return fallback_us;
  };
  use.watchdog_us = watchdog("watchdog_ms", use.watchdog_us);
  use.watchdog_reduced_us = watchdog("watchdog_reduced_ms", std::max(use.watchdog_reduced_us, use.watchdog_us));
}

void DeviceUseReader::check_limits(const xml::Element& element, const DeviceUse& use, Duration sampling) {
  const auto least_us = std::min(use.watchdog_us, use.watchdog_reduced_us);
  const Duration period = sampling * use.every;
  if (sampling != Duration{} && std::chrono::microseconds{least_us} <= period)
    problems_.add(element, "E0229",
                  fmt::format("a watchdog of {} us trips between cycles of {} us", least_us, period / 1us),
                  "watchdog_ms and watchdog_reduced_ms are longer than the period; 10 and 50 ms unless they are given");
  if (use.every > 1 && std::min(use.silence.realtime, use.silence.reduced) <= use.every)
    problems_.add(element, "E0234",
                  fmt::format("a frame every {} cycles is silence within {}", use.every,
                              std::min(use.silence.realtime, use.silence.reduced)),
                  "silence and silence_reduced are cycles, and more than those from one frame to the next");
}

/// A device that has let go meanwhile takes nothing by another way either: it latches.
void DeviceUseReader::check_fall_backs(const xml::Element& element, const DeviceUse& use, Duration sampling) {
  if (use.fall_backs.empty() || use.device >= subsystem_.devices.size() || !subsystem_.devices[use.device].actuator)
    return;
  for (const auto& [cycles, watchdog_us] :
       {std::pair{use.silence.realtime, use.watchdog_us}, {use.silence.reduced, use.watchdog_reduced_us}})
    if (std::chrono::microseconds{watchdog_us} <= sampling * (cycles + 1))
      return problems_.add(
          element, "E0235",
          fmt::format("a watchdog of {} us trips before a fall-back is tried, after {} cycles of {} us", watchdog_us,
                      cycles, sampling / 1us),
          "a longer watchdog_ms or watchdog_reduced_ms, or less silence");
}

void DeviceUseReader::read_fall_back(const xml::Element& element, DeviceUse& use) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  Endnode found = read_address(attributes, problems_);
  const auto same = [&](const Endnode& other) {
    return other.transfer == found.transfer && other.address == found.address;
  };
  if (!found.address.empty() && (same(use.endnode) || std::ranges::any_of(use.fall_backs, same)))
    problems_.add(found.at, "E0222", fmt::format("{} is tried already", in_quotes(found.address)),
                  "a fall-back has an address of its own");
  use.fall_backs.push_back(std::move(found));
  use.fall_backs.back().byte_order = use.endnode.byte_order;
  use.fall_backs.back().framing = use.endnode.framing;
}

void DeviceUseReader::read_endnode(Attributes& attributes, DeviceUse& use) {
  use.endnode = read_address(attributes, problems_);
  use.endnode.framing = attributes.one_of("framing", Framing::Frames);
  // Who was stopped and goes on sends what is old: a device with a protocol of its own has neither epoch nor watchdog against it.
  const Device* device = use.device < subsystem_.devices.size() ? &subsystem_.devices[use.device] : nullptr;
  if (use.endnode.framing == Framing::Raw && device != nullptr && device->actuator && !device->enable)
    problems_.add(*attributes.optional("framing"), "E0348",
                  fmt::format("the actuator '{}' has a protocol that knows no epoch, and no <Enable>", device->name),
                  "give it a second inhibit that the supervisor's side holds, or device frames");
  if (const auto* order = attributes.optional("byte_order"); order != nullptr && order->value != "native")
    use.endnode.byte_order = attributes.one_of("byte_order", ByteOrder::Little);
}

}  // namespace hirosco::descriptor::detail
