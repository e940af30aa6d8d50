// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/read/detail/configuration_reader.hpp"

/// Configurations between which a subsystem goes while it acts (docs/adr/0096): what is against it is said here, before any flight.
namespace hirosco::descriptor::detail {
namespace {

[[nodiscard]] bool same_end(const Endnode& one, const Endnode& other) {
  return one.transfer == other.transfer && one.address == other.address && one.byte_order == other.byte_order;
}

[[nodiscard]] bool same_limit(const CycleLimit& one, const CycleLimit& other) {
  return one.realtime == other.realtime && one.reduced == other.reduced;
}

[[nodiscard]] bool same_setting(const Setting& one, const Setting& other) {
  return one.name == other.name && one.value == other.value;
}

[[nodiscard]] bool same_use(const DeviceUse& one, const DeviceUse& other) {
  return one.device == other.device && same_limit(one.silence, other.silence) && one.every == other.every &&
         one.watchdog_us == other.watchdog_us && one.watchdog_reduced_us == other.watchdog_reduced_us &&
         std::ranges::equal(one.settings, other.settings, same_setting) && same_end(one.endnode, other.endnode) &&
         std::ranges::equal(one.fall_backs, other.fall_backs, same_end);
}

[[nodiscard]] bool same_terms(const LinkTerms& one, const LinkTerms& other) {
  return one.methods == other.methods && one.byte_orders == other.byte_orders && one.kinds == other.kinds;
}

[[nodiscard]] bool same_field(const Field& one, const Field& other) {
  return one.name == other.name && one.type == other.type && one.count == other.count && one.unit == other.unit;
}

[[nodiscard]] bool same_required(const Requires& one, const Requires& other) {
  return one.name == other.name && one.from == other.from && same_terms(one.terms, other.terms) &&
         one.depth == other.depth && one.required == other.required && same_limit(one.age, other.age) &&
         one.missing == other.missing && std::ranges::equal(one.fields, other.fields, same_field);
}

[[nodiscard]] bool same_provided(const Provides& one, const Provides& other) {
  return one.name == other.name && same_terms(one.terms, other.terms) &&
         std::ranges::equal(one.parameters, other.parameters, {}, &ParameterRef::text, &ParameterRef::text) &&
         std::ranges::equal(one.fields, other.fields, same_field);
}

/// What is against going from one to the other without a break; empty when nothing is.
[[nodiscard]] std::string against(const Configuration& one, const Configuration& other) {
  if (!std::ranges::equal(one.devices, other.devices, same_use))
    return "they do not use the same devices in the same way: endnodes, fall-backs, settings, limits, order";
  if (!std::ranges::equal(one.requires_, other.requires_, same_required))
    return "they do not require the same sets, in the same order and by the same terms";
  if (!std::ranges::equal(one.provides, other.provides, same_provided))
    return "they do not provide the same sets, in the same order and by the same terms";
  if (one.started_by != other.started_by || one.least != other.least)
    return "their cycles do not begin alike: started_by, least_us";
  if (one.sampling != other.sampling && !one.provides.empty())
    return fmt::format("the consumers of '{}' have agreed on its period, {} and {} us", one.provides.front().name,
                       one.sampling / 1us, other.sampling / 1us);
  if (one.self_test == SelfTest::Required || other.self_test == SelfTest::Required)
    return "a required self test is passed before Operational, in Safe-Operational";
  return {};
}

}  // namespace

void BumplessReader::read(const xml::Element& element) {
  Attributes attributes{element, problems_};
  Bumpless bumpless;
  bumpless.at = place(element.at);
  std::vector<const Configuration*> all;
  if (const auto* between = attributes.required("between")) {
    for (const std::string_view name : words(between->value)) {
      const auto found = std::ranges::find(subsystem_.configurations, name, &Configuration::name);
      if (found == subsystem_.configurations.end()) {
        std::vector<std::string_view> known;
        for (const Configuration& each : subsystem_.configurations) known.push_back(each.name);
        problems_.add(*between, "E0246", fmt::format("the subsystem has no configuration '{}'", name),
                      did_you_mean(name, known));
        continue;
      }
      const bool twice = std::ranges::any_of(subsystem_.bumpless, [&](const Bumpless& earlier) {
        return std::ranges::find(earlier.configurations, found->id) != earlier.configurations.end();
      });
      if (twice || std::ranges::find(all, &*found) != all.end())
        problems_.add(*between, "E0246", fmt::format("'{}' stands in a <Bumpless> twice", name),
                      "those that are compatible stand in one, each once");
      else all.push_back(&*found);
    }
    if (words(between->value).size() < 2)
      problems_.add(*between, "E0246", "one configuration alone goes nowhere", "name two, or more");
    for (const Configuration* other : all) {
      const std::string why = other == all.front() ? std::string{} : against(*all.front(), *other);
      if (!why.empty())
        problems_.add(*between, "E0246",
                      fmt::format("'{}' and '{}' are not compatible: {}", all.front()->name, other->name, why),
                      "what differs is changed by way of Post-Operational");
    }
  }
  for (const Configuration* each : all) bumpless.configurations.push_back(each->id);
  Unique names{"step of an output", "E0201"};
  each_child(element, problems_, {{"Step", [&](const auto& child) { read_step(child, bumpless, names); }, 255}});
  check_steps(element, bumpless);
  subsystem_.bumpless.push_back(std::move(bumpless));
}

void BumplessReader::read_step(const xml::Element& element, Bumpless& bumpless, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  Bumpless::Step step;
  const std::string device = attributes.name("device", NameKind::Loose);
  const std::string output = attributes.name("output");
  const auto* const most = attributes.required("most");
  const auto value = most == nullptr ? std::nullopt : attributes.number("most");
  if (value && *value < 0)
    problems_.add(*most, "E0112", fmt::format("most {} is out of range", *value),
                  "0 or more, in the unit of the output");
  step.most = value.value_or(0);
  if (device.empty() || output.empty()) return;
  const auto found = std::ranges::find(subsystem_.devices, device, &Device::name);
  if (found == subsystem_.devices.end() || !found->actuator)
    return problems_.add(*element.find("device"), "E0247", fmt::format("'{}' is no actuator", device),
                         "the outputs of actuators are held to their steps");
  const auto field =
      std::ranges::find(found->output, output, [](const Device::Output& each) { return each.field.name; });
  if (field == found->output.end())
    return problems_.add(*element.find("output"), "E0247", fmt::format("'{}' has no output '{}'", device, output));
  step.device = static_cast<std::uint16_t>(found - subsystem_.devices.begin());
  step.output = static_cast<std::uint16_t>(field - found->output.begin());
  if (names.add(device + "/" + output, place(element.at), problems_, element.name.size() + 1))
    bumpless.steps.push_back(step);
}

/// What nobody bounds might jump.
void BumplessReader::check_steps(const xml::Element& element, const Bumpless& bumpless) {
  if (bumpless.configurations.empty()) return;
  const auto configuration =
      std::ranges::find(subsystem_.configurations, bumpless.configurations.front(), &Configuration::id);
  for (const DeviceUse& use : configuration->devices) {
    const Device& device = subsystem_.devices[use.device];
    if (!device.actuator) continue;
    for (std::size_t i = 0; i < device.output.size(); ++i) {
      const bool bounded = std::ranges::any_of(
          bumpless.steps, [&](const Bumpless::Step& step) { return step.device == use.device && step.output == i; });
      if (!bounded)
        problems_.add(element, "E0247",
                      fmt::format("nothing bounds '{}' of actuator '{}' where the configuration changes",
                                  device.output[i].field.name, device.name),
                      fmt::format("add <Step device=\"{}\" output=\"{}\" most=\"...\"/>", device.name,
                                  device.output[i].field.name));
    }
  }
}

}  // namespace hirosco::descriptor::detail
