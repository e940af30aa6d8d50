// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "supervisor/supervision/procedures/procedure_runner.hpp"

namespace hirosco::supervisor {

/// Where a subsystem is.
struct Present {
  std::optional<State> state;  ///< empty: it does not say
  std::uint8_t configuration{0};  ///< in force; 0 = none
};

/// From where subsystems are to where they are wanted, as stages of a procedure. Who controls stops first, all before the first
/// gives its links back: nobody loses a set that it acts on. A configuration that requires its self test runs it before Operational.
class WayThere {
 public:
  void add(const descriptor::SubsystemDescriptor& subsystem, const descriptor::Configuration& configuration,
           const Present& from, State to);
  /// To Pre-Operational, where no configuration is in force.
  void initialise(const descriptor::SubsystemDescriptor& subsystem, const Present& from);
  /// What it was set to by telecommand, on its way to this state (docs/adr/0076).
  void recall(std::uint16_t apid, State to);
  /// To Offline.
  void down(const descriptor::SubsystemDescriptor& subsystem, const Present& from);
  /// A link of the mission; made between Pre-Operational and Safe-Operational (docs/adr/0021).
  void link(std::uint8_t id);
  /// Before somebody goes to Safe-Operational: until somebody measures what power there is, or for so long.
  void await_power(Duration at_most);
  /// At the end.
  void enter(const descriptor::Mode& mode);
  [[nodiscard]] std::vector<Stage> stages() const {
    return {stop_,        post_, pre_,         configure_, recall_,      link_,
            await_power_, safe_, recall_safe_, self_test_, operational_, mode_};
  }

 private:
  Stage stop_, post_, pre_, configure_, recall_, link_, await_power_, safe_, recall_safe_, self_test_, operational_,
      mode_;
};

}  // namespace hirosco::supervisor
