// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// What of a descriptor may change while its subsystem flies, in the same process, and what may not (docs/adr/0095).
///
/// May: ranges, initial values and `writable` of parameters; ranges and defaults of arguments; housekeeping structures; of a
/// configuration its power, its <Set>s, how long its self test may take and its limit of overruns; of a device in a configuration its
/// endnode, fall-backs, limits and the values of its settings; ranges and safe values of what a device is told that is no
/// actuator; the age after which a required set is stale; descriptions.
/// Everything else is what memory, threads, links, sandbox or guard were made by.
namespace hirosco::descriptor {

/// Of every problem of a text that is good and cannot be taken in flight (docs/descriptor-errors.md).
extern const char* const not_in_flight;

/// A change that needs another process.
struct Obstacle {
  Location at;  ///< in the new descriptor; where what is gone stood, in the old one
  std::string what;  ///< "parameter GAIN: its type"
  std::string_view why;
};

/// All that is different and may not be; empty: `fresh` can be taken. Both with what every subsystem has. Realtime: allocates.
[[nodiscard]] std::vector<Obstacle> obstacles(const SubsystemDescriptor& flown, const SubsystemDescriptor& fresh);

/// What the configuration with this id was made of and is different: it is in force, and has to be given back first.
/// Realtime: allocates.
[[nodiscard]] std::vector<Obstacle> obstacles_in_force(const SubsystemDescriptor& flown,
                                                       const SubsystemDescriptor& fresh, std::uint8_t id);

/// Takes what may change, obstacles() being empty. No parameter, function, event, device, configuration or real-time set moves in memory:
/// who refers to one goes on doing so. Nor is touched what is the same, for a cycle may be reading it. Realtime: allocates.
void take_over(SubsystemDescriptor& flown, SubsystemDescriptor&& fresh);

}  // namespace hirosco::descriptor
