// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t least_sampling_us = least_sampling / std::chrono::microseconds{1};
constexpr std::int64_t max_sampling_us = 3'600'000'000;  // an hour
constexpr double max_watchdog_ms = 60'000;

}  // namespace

void SubsystemReader::read_configuration(const xml::Element& element) {
  Attributes attributes{element, problems_};
  Configuration configuration;
  configuration.at = place(element.at);
  configuration.name = attributes.name();
  configuration.id = attributes.required_integer<std::uint8_t>("id", 1, 255);
  configuration.priority = attributes.integer_or<int>("priority", 0, greatest_cycle_priority, 0);
  configuration.sampling = std::chrono::microseconds{
      attributes.required_integer<std::int64_t>("sampling_us", least_sampling_us, max_sampling_us)};
  read_start(attributes, configuration);
  read_budget(attributes, configuration);
  read_spin(attributes, configuration);
  configuration.power_w = attributes.watts("power_W").value_or(0);
  configuration.overruns = read_limit(attributes, "overruns", "overruns_reduced", configuration.overruns);
  configuration.self_test = attributes.one_of("self_test", SelfTest::Optional);
  configuration.self_test_within = self_test_within_;
  configuration.provides = provides_;
  configuration.requires_ = requires_;

  Unique structure_ids = structure_ids_, provided = provided_, required = required_;
  Services services{configuration.housekeeping,
                    configuration.provides,
                    configuration.requires_,
                    structure_ids,
                    provided,
                    required,
                    configuration.self_test_within,
                    true};
  Unique devices{"device", "E0201"};
  auto children = service_children(services);
  children.push_back({"Device", [&](const auto& child) { read_device_use(child, configuration, devices); }, 255});
  Unique set{"parameter", "E0201"};
  children.push_back({"Set", [&](const auto& child) { read_set(child, configuration, set); }, 1024});
  Unique uses{"service", "E0201"};
  children.push_back(
      {"Service", [&](const auto& child) { read_service(child, configuration.services, uses, true); }, 255});
  each_child(element, problems_, children);
  check_start(element, configuration);
  check_housekeeping_offered(element, configuration);

  if (!configuration.name.empty())
    configuration_names_.add(configuration.name, configuration.at, problems_, element.name.size() + 1);
  if (configuration.id != 0)
    configuration_ids_.add(std::to_string(configuration.id), place(element.find("id")->value_at), problems_,
                           element.find("id")->value.size());
  subsystem_.configurations.push_back(std::move(configuration));
}

void SubsystemReader::read_budget(Attributes& attributes, Configuration& configuration) {
  configuration.budget =
      std::chrono::microseconds{attributes.integer_or<std::int64_t>("budget_us", 1, max_sampling_us, 0)};
  const Duration period = configuration.shortest();
  if (period == Duration{} || configuration.budget <= period) return;
  problems_.add(
      *attributes.optional("budget_us"), "E0227",
      fmt::format("a cycle of {} us every {} us is an overrun each time", configuration.budget / 1us, period / 1us),
      "the budget is at most the sampling period, or the least distance of cycles that samples start");
}

/// Of a precise cycle (adr 0104). It is no favour: the processor is everybody's, and the spin is reckoned as its work is.
void SubsystemReader::read_spin(Attributes& attributes, Configuration& configuration) {
  const auto* spin = attributes.optional("spin_us");
  if (spin == nullptr) return;
  configuration.spin = std::chrono::microseconds{
      attributes.integer_or<std::int64_t>("spin_us", 1, greatest_spin / std::chrono::microseconds{1}, 0)};
  const auto refuse = [&](std::string message, std::string hint) {
    problems_.add(*spin, "E0253", std::move(message), std::move(hint));
  };
  if (!configuration.started_by.empty())
    return refuse("a cycle that samples start is due at no instant", "spin_us is of a cycle that the clock starts");
  if (configuration.priority == 0)
    return refuse("a precise cycle has no priority", "priority: without one it would take turns with everybody");
  if (configuration.budget == Duration{})
    return refuse("a precise cycle declares no budget", "budget_us: whether there is room to spin is reckoned with it");
  if (configuration.sampling == Duration{} || configuration.load() <= configuration.sampling) return;
  refuse(fmt::format("{} us of spin and {} us of budget are more than a period of {} us", configuration.spin / 1us,
                     configuration.budget / 1us, configuration.sampling / 1us),
         "lower spin_us or budget_us, or raise sampling_us");
}

/// Of a cycle that samples start: by which set, and how soon one may follow another.
void SubsystemReader::read_start(Attributes& attributes, Configuration& configuration) {
  const auto* set = attributes.optional("started_by");
  const auto* least = attributes.optional("least_us");
  if (set == nullptr && least == nullptr) return;
  if (set == nullptr || least == nullptr)
    return problems_.add(set == nullptr ? *least : *set, "E0250",
                         fmt::format("'{}' without '{}'", set == nullptr ? "least_us" : "started_by",
                                     set == nullptr ? "started_by" : "least_us"),
                         "both of a cycle that samples start: the set, and the shortest distance of two cycles");
  configuration.least = std::chrono::microseconds{
      attributes.required_integer<std::int64_t>("least_us", least_sampling_us, max_sampling_us)};
  configuration.started_by = attributes.name("started_by");
  if (configuration.sampling == Duration{} || configuration.least <= configuration.sampling) return;
  problems_.add(*least, "E0250",
                fmt::format("a cycle is to wait {} us at least and {} us at most", configuration.least / 1us,
                            configuration.sampling / 1us),
                "least_us is at most sampling_us, the longest wait");
}

void SubsystemReader::check_start(const xml::Element& element, Configuration& configuration) {
  if (configuration.started_by.empty()) return;
  const auto set = std::ranges::find(configuration.requires_, configuration.started_by, &Requires::name);
  if (set == configuration.requires_.end()) {
    std::vector<std::string_view> known;
    for (const Requires& each : configuration.requires_) known.push_back(each.name);
    return problems_.add(*element.find("started_by"), "E0251",
                         fmt::format("set {} is not required here", in_quotes(configuration.started_by)),
                         did_you_mean(configuration.started_by, known));
  }
  set->starts = true;
  const auto wakes = [&](LinkMethod method) {
    const LinkMechanism* mechanism = find_link_mechanism(standard_link_mechanisms(), method, set->kind());
    return mechanism != nullptr && mechanism->wakes();
  };
  if (std::ranges::any_of(set->terms.methods, wakes)) return;
  problems_.add(*element.find("started_by"), "E0252",
                fmt::format("set {} comes by no method that wakes", in_quotes(configuration.started_by)),
                "methods=\"shared_memory\", or sampling_us alone: the clock");
}

std::optional<std::uint16_t> SubsystemReader::find_device(const xml::Element& element, const std::string& name,
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

void SubsystemReader::read_device_use(const xml::Element& element, Configuration& configuration, Unique& names) {
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
void SubsystemReader::read_endnode_use(const xml::Element& element, const DeviceUse& common, const std::string& device,
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

void SubsystemReader::read_limits(Attributes& attributes, DeviceUse& use) {
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

void SubsystemReader::check_limits(const xml::Element& element, const DeviceUse& use, Duration sampling) {
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
void SubsystemReader::check_fall_backs(const xml::Element& element, const DeviceUse& use, Duration sampling) {
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

void SubsystemReader::read_fall_back(const xml::Element& element, DeviceUse& use) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  Endnode found = read_address(attributes);
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

void SubsystemReader::read_endnode(Attributes& attributes, DeviceUse& use) {
  use.endnode = read_address(attributes);
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

Endnode SubsystemReader::read_address(Attributes& attributes) {
  Endnode endnode;
  endnode.at = place(attributes.element().at);
  if (const auto* transfer = attributes.required("transfer"); transfer != nullptr) {
    const auto known = attributes.word<Transfer>(*transfer, transfer->value);
    if (known) endnode.transfer = *known;
    const FlowMeans* means = known ? find_flow_means(*known) : nullptr;
    if (known && means == nullptr)
      problems_.not_built_in(*transfer, transfer->value, are_built_in(standard_flow_means(), &FlowMeans::transfer));
    const auto* address = attributes.required("address");
    if (address != nullptr) {
      endnode.address = address->value;
      const std::string wrong = means != nullptr ? refuse_address(means->form, endnode.address) : "";
      if (!wrong.empty())
        problems_.add(*address, "E0217",
                      fmt::format("{} is no address for {}", in_quotes(endnode.address), transfer->value), wrong);
    }
  }
  static_cast<void>(attributes.required("address"));
  return endnode;
}

void SubsystemReader::check_addresses() {
  std::map<std::pair<Transfer, std::string>, std::pair<std::string, Location>> taken;
  const auto take = [&](const Endnode& endnode, const std::string& user) {
    if (endnode.address.empty()) return;
    const auto [before, first] = taken.try_emplace({endnode.transfer, endnode.address}, user, endnode.at);
    if (first || before->second.first == user) return;
    problems_.add(
        endnode.at, "E0222",
        fmt::format("address {} of {} belongs to {}", in_quotes(endnode.address), user, before->second.first),
        fmt::format("see {}:{}; each needs its own", before->second.second.line, before->second.second.column));
  };
  for (const Device& device : subsystem_.devices)
    if (device.enable) take(*device.enable, fmt::format("the enable endnode of device '{}'", device.name));
  for (const PowerSwitch& power : subsystem_.power_switches)
    take(power.endnode, fmt::format("the power switch of device '{}'", power.device));
  for (const Configuration& configuration : subsystem_.configurations)
    for (const DeviceUse& use : configuration.devices) {
      if (use.device >= subsystem_.devices.size()) continue;
      const std::string& name = subsystem_.devices[use.device].name;
      take(use.endnode, fmt::format("device '{}'", name));
      for (const Endnode& other : use.fall_backs) take(other, fmt::format("device '{}'", name));
    }
}

void SubsystemReader::read_set(const xml::Element& element, Configuration& configuration, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* name = attributes.required("parameter");
  const auto* value = attributes.required("value");
  auto reference = name == nullptr ? std::nullopt : resolve(*name, "<Set>");
  if (!reference || value == nullptr) return;
  names.add(name->value, place(name->value_at), problems_, name->value.size());
  if (subsystem_.parameters[reference->parameter].persistent)
    return problems_.add(*name, "E0238", fmt::format("'{}' is persistent and set by a configuration", reference->text),
                         "one of the two: what telecommands set counts until they set it again");
  const auto fields = fields_of(subsystem_, *reference);
  auto values = read_values(problems_, *value, reference->text, fields, subsystem_.enumerations);
  if (values) configuration.initial.push_back({std::move(*reference), std::move(*values)});
}

}  // namespace hirosco::descriptor::detail
