// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include "hirosco/subsystem/service_loop/introduced_ports.hpp"

#include <utility>

#include "hirosco/subsystem/cycle/device_slot.hpp"
#include "hirosco/subsystem/cycle/layout_difference.hpp"

namespace hirosco {
namespace {

constexpr const char* as_declared = "give the C++ type a member for each <Field>, in their order and of their types";

/// What samples of a kind are, and which port takes them.
struct PortWanted {
  const char* samples;
  const char* port;
};
[[nodiscard]] constexpr PortWanted port_wanted(LinkKind kind) noexcept {
  switch (kind) {
    case LinkKind::Loaned: return {"lent", "LoanInput"};
    case LinkKind::Queued: return {"queued", "QueueInput"};
    default: return {"copied", "LinkInput"};
  }
}

template <class Named>
[[nodiscard]] typename Named::mapped_type port_named(const Named& ports, std::string_view name) noexcept {
  const auto found = ports.find(name);
  return found != ports.end() ? found->second : nullptr;
}

}  // namespace

void IntroducedPorts::forget() {
  links_.clear();
  lent_.clear();
  devices_.clear();
}

LinkInputPort* IntroducedPorts::link(std::string_view set) const noexcept { return port_named(links_, set); }
LoanOutputPort* IntroducedPorts::lent(std::string_view set) const noexcept { return port_named(lent_, set); }
DevicePortBase* IntroducedPorts::device(std::string_view name) const noexcept { return port_named(devices_, name); }

std::vector<Mistake> IntroducedPorts::mistakes(const descriptor::Configuration& configuration) const {
  std::vector<Mistake> found;
  compare_links(configuration, found);
  compare_devices(configuration, found);
  return found;
}

void IntroducedPorts::compare_links(const descriptor::Configuration& configuration, std::vector<Mistake>& found) const {
  const auto add = [&](std::string text, descriptor::Location at, std::string remedy) {
    found.push_back({.text = std::move(text), .at = at, .remedy = std::move(remedy)});
  };
  for (const descriptor::Requires& wanted : configuration.requires_) {
    const std::string whose = "require_link " + wanted.name + ": ";
    const auto [samples, kind] = port_wanted(wanted.kind());
    const LinkInputPort* const port = link(wanted.name);
    if (port == nullptr) {
      add(whose + "the set is required and has no port", wanted.at,
          std::string{"name a "} + kind + " for it in software_init()");
      continue;
    }
    if (const auto difference = layout_difference(port->layout(), wanted.fields); !difference.empty())
      add(whose + difference, wanted.at, as_declared);
    if (port->kind() != wanted.kind())
      add(whose + "is " + samples + ", its port is no " + kind, wanted.at,
          std::string{"make the port a "} + kind + ", or change the kind of the set");
  }
  for (const descriptor::Provides& provided : configuration.provides) {
    if (!provided.terms.lent()) continue;
    const LoanOutputPort* const port = lent(provided.name);
    if (port == nullptr)
      add("set lent but without a place to make it, lend_link: " + provided.name, provided.at,
          "name a LoanOutput for it in software_init()");
    else if (const auto difference = layout_difference(port->layout(), provided.fields); !difference.empty())
      add("lend_link " + provided.name + ": " + difference, provided.at, as_declared);
  }
}

void IntroducedPorts::compare_devices(const descriptor::Configuration& configuration,
                                      std::vector<Mistake>& found) const {
  for (const descriptor::DeviceUse& use : configuration.devices) {
    // Where the device is declared: in however many configurations it is used, it is one mistake.
    const descriptor::Device& declared = descriptor_.devices[use.device];
    const std::string whose = "use_device " + declared.name + ": ";
    const DevicePortBase* const port = device(declared.name);
    if (port == nullptr)
      found.push_back({.text = whose + "the device is used and has no port",
                       .at = declared.at,
                       .remedy = "name a DevicePort for it in software_init()"});
    else if (const auto difference = DeviceSlot::difference(declared, *port); !difference.empty())
      found.push_back({.text = whose + difference, .at = declared.at, .remedy = as_declared});
    if (use.endnode.framing == Framing::Raw && port != nullptr && port->protocol() == nullptr)
      found.push_back({.text = "device '" + declared.name +
                               "' is reached with framing=\"raw\", and its port does not speak() a protocol",
                       .at = use.endnode.at,
                       .remedy = "call speak() of its port before use_device(), or leave the framing out"});
    for (const descriptor::Setting& setting : use.settings)
      if (port == nullptr || !port->reads(setting.name))
        found.push_back({.text = "nobody reads setting '" + setting.name + "' of '" + declared.name + "'",
                         .at = setting.at,
                         .code = "E0405",
                         .remedy = "name it in use_device(), or leave it out"});
  }
}

}  // namespace hirosco
