// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/device_arguments.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "hirosco/descriptor/model/setting_files.hpp"

namespace hirosco::simulation {
namespace {

FlowAddress address_of(const descriptor::Endnode& endnode) { return {endnode.transfer, endnode.address}; }

SimulatedDevice::Stop stop_of(descriptor::StopKind kind) {
  switch (kind) {
    case descriptor::StopKind::Drop: break;
    case descriptor::StopKind::Controlled: return SimulatedDevice::Stop::Controlled;
    case descriptor::StopKind::Hold: return SimulatedDevice::Stop::Hold;
  }
  return SimulatedDevice::Stop::Drop;
}

const char* text_of(SimulatedDevice::Stop stop) {
  switch (stop) {
    case SimulatedDevice::Stop::Drop: break;
    case SimulatedDevice::Stop::Controlled: return "controlled";
    case SimulatedDevice::Stop::Hold: return "hold";
  }
  return "drop";
}

const char* text_of(std::endian order) { return order == std::endian::big ? "big" : "little"; }

/// As the program of a device reads it: TRANSFER=ADDRESS.
std::string text_of(const FlowAddress& address) {
  return fmt::format("{}={}", to_text(address.transfer), address.address);
}

template <class Unit>
std::string count_of(Duration span) {
  return std::to_string(std::chrono::duration_cast<Unit>(span).count());
}

}  // namespace

FlowAddress DeviceArguments::address() const { return address_of(endnode); }

std::vector<std::string> DeviceArguments::arguments() const {
  std::vector<std::string> words{"--transfer",       std::string{to_text(endnode.transfer)},
                                 "--address",        endnode.address,
                                 "--byte-order",     text_of(settings.byte_order),
                                 "--cycle-us",       count_of<std::chrono::microseconds>(settings.cycle),
                                 "--stop",           text_of(settings.stop),
                                 "--stop-within-ms", count_of<std::chrono::milliseconds>(settings.stop_within)};
  if (settings.actuator) words.push_back("--actuator");
  if (enable)
    words.insert(words.end(),
                 {"--enable-transfer", std::string{to_text(enable->transfer)}, "--enable-address", enable->address});
  for (const FlowAddress& other : settings.enable_fall_backs)
    words.insert(words.end(), {"--enable-fall-back", text_of(other)});
  for (const FlowAddress& other : settings.fall_backs) words.insert(words.end(), {"--fall-back", text_of(other)});
  if (!settings.endnode.empty()) words.insert(words.end(), {"--endnode", settings.endnode});
  for (const FurtherEndnode& further : settings.further) {
    std::string text = fmt::format("{},{}", further.name, text_of(further.byte_order));
    for (const FlowAddress& address : further.addresses) text += "," + text_of(address);
    words.insert(words.end(), {"--further", text});
    if (!further.actuator) continue;
    text = fmt::format("{},{},{}", further.name, text_of(further.actuator->stop),
                       count_of<std::chrono::milliseconds>(further.actuator->stop_within));
    if (further.actuator->enable) text += "," + text_of(*further.actuator->enable);
    for (const FlowAddress& other : further.actuator->enable_fall_backs) text += "," + text_of(other);
    words.insert(words.end(), {"--drive", text});
  }
  if (settings.power) words.insert(words.end(), {"--power", text_of(*settings.power)});
  for (const FlowAddress& other : settings.power_fall_backs)
    words.insert(words.end(), {"--power-fall-back", text_of(other)});
  for (const auto& [name, file] : settings.files)
    words.insert(words.end(), {"--file", fmt::format("{}={}", name, file)});
  return words;
}

namespace {

using Addresses = std::vector<FlowAddress>;

/// One of the endnodes that a device plays, as every configuration that uses it says.
struct Played {
  const descriptor::Device* device{nullptr};
  Addresses addresses;  ///< preferred, then fall-backs
  descriptor::ByteOrder byte_order{};
  const descriptor::Configuration* first{nullptr};
  Duration cycle{};
};

[[nodiscard]] Addresses addresses_of(const std::vector<descriptor::Endnode>& endnodes) {
  Addresses found;
  for (const auto& each : endnodes) found.push_back(address_of(each));
  return found;
}

[[nodiscard]] Addresses addresses_of(const descriptor::DeviceUse& use) {
  Addresses found{address_of(use.endnode)};
  for (const auto& other : use.fall_backs) found.push_back(address_of(other));
  return found;
}

[[nodiscard]] bool same(const Addresses& left, const Addresses& right) {
  return std::ranges::equal(left, right, [](const FlowAddress& one, const FlowAddress& other) {
    return one.transfer == other.transfer && one.address == other.address;
  });
}

/// Adds the files that a configuration's settings of it name. In words which two configurations do not agree about.
[[nodiscard]] std::optional<std::string> add_files(const descriptor::SubsystemDescriptor& subsystem,
                                                   const descriptor::DeviceUse& use,
                                                   std::map<std::string, std::string>& files) {
  for (const descriptor::Setting& setting : use.settings) {
    if (!descriptor::names_file(setting)) continue;
    const std::string file = descriptor::file_of(subsystem, setting.value).string();
    if (const auto [known, is_new] = files.emplace(setting.name, file); !is_new && known->second != file)
      return fmt::format("configurations of {} name different files by {}, and its device has one world",
                         subsystem.name, setting.name);
  }
  return std::nullopt;
}

[[nodiscard]] std::string file_beside(const std::filesystem::path& mission, const std::string& value) {
  return value.starts_with('@') ? value : (mission.parent_path() / value).lexically_normal().string();
}

/// Empty `first`: no configuration uses it.
[[nodiscard]] std::expected<Played, std::string> how_played(const descriptor::SubsystemDescriptor& subsystem,
                                                            const descriptor::Device& device) {
  Played played;
  played.device = &device;
  for (const auto& configuration : subsystem.configurations)
    for (const auto& use : configuration.devices) {
      if (&subsystem.devices[use.device] != &device) continue;
      if (use.endnode.framing == Framing::Raw)
        return std::unexpected{
            fmt::format("{} of {} has a protocol of its own, and a simulated device speaks device frames", device.name,
                        subsystem.name)};
      if (played.first == nullptr) {
        played = {&device, addresses_of(use), use.endnode.byte_order, &configuration, configuration.sampling};
        continue;
      }
      if (!same(played.addresses, addresses_of(use)) || use.endnode.byte_order != played.byte_order)
        return std::unexpected{
            fmt::format("configurations {} and {} of {} have different endnodes for {}, and it has one",
                        played.first->name, configuration.name, subsystem.name, device.name)};
      played.cycle = std::min(played.cycle, configuration.sampling);
    }
  return played;
}

[[nodiscard]] std::optional<FurtherActuator> actuator_of(const descriptor::Device& device) {
  if (!device.actuator) return std::nullopt;
  FurtherActuator made{.stop = stop_of(device.stop), .stop_within = device.stop_within};
  if (device.enable) made.enable = address_of(*device.enable);
  made.enable_fall_backs = addresses_of(device.enable_terms.fall_backs);
  return made;
}

[[nodiscard]] std::endian endian_of(descriptor::ByteOrder order) {
  return order == descriptor::ByteOrder::Big ? std::endian::big : std::endian::little;
}

}  // namespace

std::expected<DeviceArguments, std::string> device_arguments(const descriptor::Mission& mission,
                                                             const descriptor::SimulatedDevice& device) {
  const auto* member = mission.find_subsystem(device.subsystem);
  if (member == nullptr) return std::unexpected{fmt::format("there is no subsystem {}", device.subsystem)};
  const descriptor::SubsystemDescriptor& subsystem = member->subsystem;
  std::vector<Played> endnodes;
  bool known = false;
  for (const descriptor::Device& each : subsystem.devices) {
    if (each.name != device.device && each.part_of != device.device) continue;
    known = true;
    auto played = how_played(subsystem, each);
    if (!played) return std::unexpected{played.error()};
    if (played->first != nullptr) endnodes.push_back(std::move(*played));
  }
  if (!known) return std::unexpected{fmt::format("{} has no device {}", device.subsystem, device.device)};
  if (endnodes.empty())
    return std::unexpected{fmt::format("no configuration of {} uses {}", device.subsystem, device.device)};
  const auto acts = [](const Played& played) { return played.device->actuator; };
  // Its world is driven by the first endnode with an actuator, else by its first one.
  if (const auto main = std::ranges::find_if(endnodes, acts); main != endnodes.end())
    std::rotate(endnodes.begin(), main, main + 1);
  const Played& main = endnodes.front();
  DeviceArguments made;
  made.enable = main.device->enable;
  made.endnode.transfer = main.addresses.front().transfer;
  made.endnode.address = main.addresses.front().address;
  made.endnode.byte_order = main.byte_order;
  SimulatedDevice::Settings& settings = made.settings;
  for (const auto& configuration : subsystem.configurations)
    for (const auto& use : configuration.devices) {
      const descriptor::Device& its = subsystem.devices[use.device];
      if (its.name != device.device && its.part_of != device.device) continue;
      if (auto differ = add_files(subsystem, use, settings.files)) return std::unexpected{std::move(*differ)};
    }
  // What the mission names is for the world alone, in place of what the subsystem has.
  for (const descriptor::Setting& setting : device.settings)
    if (descriptor::names_file(setting)) settings.files[setting.name] = file_beside(mission.file, setting.value);
  settings.cycle = main.cycle;
  settings.byte_order = endian_of(main.byte_order);
  settings.actuator = main.device->actuator;
  settings.stop = stop_of(main.device->stop);
  settings.stop_within = main.device->stop_within;
  if (made.enable) settings.enable = address_of(*made.enable);
  settings.enable_fall_backs = addresses_of(main.device->enable_terms.fall_backs);
  settings.fall_backs.assign(main.addresses.begin() + 1, main.addresses.end());
  const auto name_of = [&](const Played& played) {
    const descriptor::Device& whole = *played.device;
    return whole.part_of.empty() ? std::string{} : whole.name.substr(whole.part_of.size() + 1);
  };
  settings.endnode = name_of(main);
  for (std::size_t i = 1; i < endnodes.size(); ++i)
    settings.further.push_back({.name = name_of(endnodes[i]),
                                .addresses = endnodes[i].addresses,
                                .byte_order = endian_of(endnodes[i].byte_order),
                                .actuator = actuator_of(*endnodes[i].device)});
  const auto power = std::ranges::find(subsystem.power_switches, device.device, &descriptor::PowerSwitch::device);
  if (power == subsystem.power_switches.end()) return made;
  settings.power = address_of(power->endnode);
  settings.power_fall_backs = addresses_of(power->terms.fall_backs);
  return made;
}

std::expected<const descriptor::SimulatedDevice*, std::string> whose_world(const descriptor::Mission& mission,
                                                                           const descriptor::SimulatedDevice& device) {
  const auto said = std::ranges::find(device.settings, world_setting, &descriptor::Setting::name);
  if (said == device.settings.end()) return nullptr;
  for (const descriptor::SimulatedDevice& other : mission.devices) {
    if (other.name == device.name) break;
    const bool own =
        std::ranges::find(other.settings, world_setting, &descriptor::Setting::name) == other.settings.end();
    if (other.name == said->value && other.executable == device.executable && own) return &other;
  }
  return std::unexpected{fmt::format(
      "world '{}' is none: it names a simulated device that stands before this one, has the same executable "
      "and a world of its own",
      said->value)};
}

}  // namespace hirosco::simulation
