// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "hirosco/descriptor/read/detail/device_reader.hpp"

/// Devices as a subsystem declares them, and what is said of an endnode wherever one stands.
namespace hirosco::descriptor::detail {
namespace {

constexpr std::size_t max_name_octets = 64;

}  // namespace

void read_setting(const xml::Element& element, Problems& problems, Unique& names, std::vector<Setting>& settings) {
  Attributes attributes{element, problems};
  std::string name = attributes.name();
  const auto* value = attributes.required("value");
  no_children(element, problems);
  if (name.empty() || value == nullptr) return;
  if (value->value.size() > 256) problems.add(*value, "E0114", "the value of a setting has at most 256 octets");
  names.add(name, place(element.at), problems, element.name.size() + 1);
  settings.push_back({std::move(name), value->value, place(value->value_at)});
}

Endnode read_address(Attributes& attributes, Problems& problems) {
  Endnode endnode;
  endnode.at = place(attributes.element().at);
  if (const auto* transfer = attributes.required("transfer"); transfer != nullptr) {
    const auto known = attributes.word<Transfer>(*transfer, transfer->value);
    if (known) endnode.transfer = *known;
    const FlowMeans* means = known ? find_flow_means(*known) : nullptr;
    if (known && means == nullptr)
      problems.not_built_in(*transfer, transfer->value, are_built_in(standard_flow_means(), &FlowMeans::transfer));
    const auto* address = attributes.required("address");
    if (address != nullptr) {
      endnode.address = address->value;
      const std::string wrong = means != nullptr ? refuse_address(means->form, endnode.address) : "";
      if (!wrong.empty())
        problems.add(*address, "E0217",
                     fmt::format("{} is no address for {}", in_quotes(endnode.address), transfer->value), wrong);
    }
  }
  static_cast<void>(attributes.required("address"));
  return endnode;
}

void check_addresses(const SubsystemDescriptor& subsystem, Problems& problems) {
  std::map<std::pair<Transfer, std::string>, std::pair<std::string, Location>> taken;
  const auto take = [&](const Endnode& endnode, const std::string& user) {
    if (endnode.address.empty()) return;
    const auto [before, first] = taken.try_emplace({endnode.transfer, endnode.address}, user, endnode.at);
    if (first || before->second.first == user) return;
    problems.add(
        endnode.at, "E0222",
        fmt::format("address {} of {} belongs to {}", in_quotes(endnode.address), user, before->second.first),
        fmt::format("see {}:{}; each needs its own", before->second.second.line, before->second.second.column));
  };
  for (const Device& device : subsystem.devices)
    if (device.enable) {
      const std::string user = fmt::format("the enable endnode of device '{}'", device.name);
      take(*device.enable, user);
      for (const Endnode& other : device.enable_terms.fall_backs) take(other, user);
    }
  for (const PowerSwitch& power : subsystem.power_switches) {
    const std::string user = fmt::format("the power switch of device '{}'", power.device);
    take(power.endnode, user);
    for (const Endnode& other : power.terms.fall_backs) take(other, user);
  }
  for (const Configuration& configuration : subsystem.configurations)
    for (const DeviceUse& use : configuration.devices) {
      if (use.device >= subsystem.devices.size()) continue;
      const std::string& name = subsystem.devices[use.device].name;
      take(use.endnode, fmt::format("device '{}'", name));
      for (const Endnode& other : use.fall_backs) take(other, fmt::format("device '{}'", name));
    }
}

void DeviceReader::read(const xml::Element& element) {
  Attributes attributes{element, problems_};
  const std::string name = attributes.name("name", NameKind::Loose);
  const auto add_name = [&] {
    if (!name.empty()) device_names_.add(name, place(element.at), problems_, element.name.size() + 1);
  };
  const bool several = std::ranges::find(element.children, "Endnode", &xml::Element::name) != element.children.end();
  if (!several) {
    Device device;
    device.name = name;
    read_frames(attributes, std::move(device));
    return add_name();
  }
  add_name();
  const auto read_one = [&](const xml::Element& child) {
    Attributes own{child, problems_};
    Device device;
    device.part_of = name;
    device.name = name + "." + own.name();
    if (device.name.size() > max_name_octets)
      problems_.add(
          child, "E0114", fmt::format("'{}' is too long", device.name),
          fmt::format("name of device and endnode have at most {} characters, with the dot", max_name_octets));
    device_names_.add(device.name, place(child.at), problems_, child.name.size() + 1);
    read_frames(own, std::move(device));
  };
  each_child(
      element, problems_,
      {{"Endnode", read_one, max_device_endnodes}, {"Power", [&](const auto& power) { read_power(power, name); }, 1}});
}

/// What a device, or an endnode of one that has several, exchanges.
void DeviceReader::read_frames(Attributes& attributes, Device device) {
  const xml::Element& element = attributes.element();
  device.at = place(element.at);
  device.actuator = attributes.yes("actuator", false);
  read_stop(attributes, device);
  Unique inputs{"input field", "E0201"}, outputs{"output field", "E0201"};
  std::vector<Child> known{
      {"Input",
       [&](const xml::Element& input) {
         const Attributes none{input, problems_};
         each_child(input, problems_,
                    {{"Field", [&](const auto& field) { fields_.read_plain(field, device.input, inputs); }}});
       },
       1},
      {"Output",
       [&](const xml::Element& output) {
         const Attributes none{output, problems_};
         each_child(output, problems_, {{"Field", [&](const auto& field) { read_output(field, device, outputs); }}});
       },
       1},
      {"Enable", [&](const auto& enable) { read_enable(enable, device); }, 1}};
  // Power is a whole device's.
  if (device.part_of.empty()) known.push_back({"Power", [&](const auto& power) { read_power(power, device.name); }, 1});
  each_child(element, problems_, known);
  if (device.input.empty() && device.output.empty())
    problems_.add(element, "E0106", fmt::format("<{}> needs a <Field> of <Input> or <Output>", element.name));
  check_octets(element, device);
  if (device.actuator && device.output.empty())
    problems_.add(element, "E0106", "an actuator needs an <Output> with at least one <Field>");
  if (device.actuator && !device.enable)
    problems_.warn(device.at, "E0403", fmt::format("actuator '{}' has no second inhibit", device.name),
                   "only its subsystem keeps it from moving: add <Enable transfer=\"...\" address=\"...\"/>",
                   element.name.size() + 1);
  subsystem_.devices.push_back(std::move(device));
}

void DeviceReader::read_stop(Attributes& attributes, Device& device) {
  device.stop = attributes.one_of("stop", StopKind::Drop);
  device.stop_within = std::chrono::milliseconds{attributes.integer_or<std::int64_t>("stop_within_ms", 1, 60'000, 0)};
  const xml::Element& element = attributes.element();
  const auto* within = attributes.optional("stop_within_ms");
  if (element.find("stop") != nullptr && device.stop == StopKind::Controlled && within == nullptr)
    problems_.add(element, "E0105", "<Device stop=\"controlled\"> needs the attribute 'stop_within_ms'",
                  "the time in which it comes to rest by itself");
  for (const std::string_view name : {"stop", "stop_within_ms"})
    if (element.find(name) != nullptr && !device.actuator)
      problems_.add(*element.find(name), "E0223",
                    fmt::format("'{}' is no actuator: it has nothing to stop", device.name), "actuator=\"yes\"");
}

void DeviceReader::check_octets(const xml::Element& element, const Device& device) {
  std::size_t input = 0, output = 0;
  for (const Field& field : device.input) input += field.octets();
  for (const Device::Output& out : device.output) output += out.field.octets();
  for (const auto& [direction, octets] : {std::pair{"input", input}, {"output", output}})
    if (octets > max_device_octets)
      problems_.add(element, "E0215",
                    fmt::format("the {} of device '{}' takes {} octets", direction, device.name, octets),
                    fmt::format("at most {}", max_device_octets));
}

void DeviceReader::read_output(const xml::Element& element, Device& device, Unique& names) {
  Attributes attributes{element, problems_};
  Device::Output output;
  output.field = fields_.read(attributes, Says::Range);
  output.safe = read_numbers(problems_, attributes, "safe", output.field);
  no_children(element, problems_);
  const xml::Attribute* const safe = element.find("safe");
  // Who writes it believes that the output is taken away in some state.
  if (!device.actuator && safe != nullptr)
    problems_.add(
        *safe, "E0223",
        fmt::format("'{}' is no actuator: its output '{}' goes out in every state", device.name, output.field.name),
        "actuator=\"yes\", or leave it out");
  if (device.actuator && safe == nullptr)
    problems_.add(element, "E0218", fmt::format("output '{}' of an actuator needs its safe value", output.field.name),
                  "add the attribute safe: it is sent in every state but Operational");
  if (!output.field.name.empty()) names.add(output.field.name, place(element.at), problems_, element.name.size() + 1);
  device.output.push_back(std::move(output));
}

}  // namespace hirosco::descriptor::detail
