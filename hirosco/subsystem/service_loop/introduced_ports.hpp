// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/service_loop/mistake.hpp"

namespace hirosco {

/// The ports of links and devices that an author has named, compared with what a configuration uses.  Thread: the service loop.
class IntroducedPorts {
 public:
  explicit IntroducedPorts(const descriptor::SubsystemDescriptor& descriptor) noexcept : descriptor_{descriptor} {}

  /// The port named last is the one that counts.
  void require_link(std::string_view set, LinkInputPort& port) { links_[std::string{set}] = &port; }
  void lend_link(std::string_view set, LoanOutputPort& port) { lent_[std::string{set}] = &port; }
  void use_device(std::string_view name, DevicePortBase& port) { devices_[std::string{name}] = &port; }
  void forget();

  /// Null: nobody named one for it.
  [[nodiscard]] LinkInputPort* link(std::string_view set) const noexcept;
  [[nodiscard]] LoanOutputPort* lent(std::string_view set) const noexcept;
  [[nodiscard]] DevicePortBase* device(std::string_view name) const noexcept;

  /// All that this configuration lacks of ports, and what of them is not as the descriptor says. Empty: it can be put in force.
  [[nodiscard]] std::vector<Mistake> mistakes(const descriptor::Configuration& configuration) const;

 private:
  template <class Port>
  using Named = std::map<std::string, Port*, std::less<>>;

  void compare_links(const descriptor::Configuration& configuration, std::vector<Mistake>& found) const;
  void compare_devices(const descriptor::Configuration& configuration, std::vector<Mistake>& found) const;

  const descriptor::SubsystemDescriptor& descriptor_;
  Named<LinkInputPort> links_;
  Named<LoanOutputPort> lent_;
  Named<DevicePortBase> devices_;
};

}  // namespace hirosco
