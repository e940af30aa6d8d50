// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/spacecraft/spacecraft.hpp"

/// A defect for each invariant, put in from outside: between the parts, never inside them, so that nothing of them is in
/// what flies (adr 0039). Findings as they were in the code are put back by defects_flown.py, into a copy of it.
namespace hirosco::campaign {

struct PlantedDefect {
  std::function<void(descriptor::Mission&)> edit{};
  std::function<void(simulation::DeviceCatalogue&)> devices{};
  std::function<std::unique_ptr<Channel>(std::string_view, std::unique_ptr<Channel>)> wrap_channel{};
  std::function<bool(const supervisor::LogRecord&)> keeps{};
  std::function<std::string(std::string)> reads{};  ///< what is read in place of a descriptor that was edited
  simulation::MistakeVersion mistake_version{};
  LinkMechanisms links{local_link_mechanisms()};
  std::vector<std::unique_ptr<LinkMechanism>> lossy_queue{};  ///< what of `links` stands in for another
  std::vector<const LinkMechanism*> tampered_links{};
  std::function<void(const std::vector<std::string>&)> after_action{};
  std::function<void()> each_instant{};
  std::uint32_t clock_percent{100};  ///< what the devices' clocks should be, in percent of what they are
  const descriptor::Mission* mission{nullptr};  ///< set before the craft is made
  simulation::Spacecraft* craft{nullptr};  ///< set before the first instant

  [[nodiscard]] double now_s() const;
};

/// Null: no defect has this name.
[[nodiscard]] std::unique_ptr<PlantedDefect> defect_named(std::string_view name);
[[nodiscard]] std::vector<std::string_view> defect_names();

}  // namespace hirosco::campaign
