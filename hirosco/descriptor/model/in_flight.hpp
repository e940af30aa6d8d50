// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// What of a descriptor may change while its subsystem flies, in the same process (docs/adr/0095) or with another one in its place (docs/adr/0214),
/// and what may not.
///
/// May: ranges, initial values and `writable` of parameters; ranges and defaults of arguments; housekeeping structures; of a
/// configuration its power, its <Set>s, how long its self test may take and its limit of overruns; of a device in a configuration its
/// endnode, fall-backs, limits and the values of its settings; ranges and safe values of what a device is told that is no
/// actuator; the age after which a required set is stale; failure codes that are new; descriptions.
/// With another process also: parameters, events, functions and enumerations that are new, no function that is essential; fields of sets of links
/// that are new, but of what is lent (docs/adr/0236).
/// Everything else is what memory, threads, links, sandbox or guard were made by.
namespace hirosco::descriptor {

/// Of every problem of a text that is good and cannot be taken in flight (docs/descriptor-errors.md).
extern const char* const not_in_flight;

/// Who is to fly by the fresh text.
enum class TakenBy : std::uint8_t {
  SameProcess,  ///< the one that runs
  AnotherProcess,  ///< one that is started with it, while nobody holds a link, a mapping or a pool of the one before
};

/// A change that cannot be taken.
struct Obstacle {
  Location at;  ///< in the new descriptor; where what is gone stood, in the old one
  std::string what;  ///< "parameter GAIN: its type"
  std::string_view why;
  bool addition{false};  ///< another process could take it
};

/// All that is different and may not be; empty: `fresh` can be taken. Both with what every subsystem has. Realtime: allocates.
[[nodiscard]] std::vector<Obstacle> obstacles(const SubsystemDescriptor& flown, const SubsystemDescriptor& fresh,
                                              TakenBy by = TakenBy::SameProcess);

/// What the configuration with this id was made of and is different: it is in force, and has to be given back first.
/// Realtime: allocates.
[[nodiscard]] std::vector<Obstacle> obstacles_in_force(const SubsystemDescriptor& flown,
                                                       const SubsystemDescriptor& fresh, std::uint8_t id);

/// Takes what may change, obstacles() being empty for one direction or the other. Where nothing is added and nothing taken back no parameter,
/// function, event, device, configuration or real-time set moves in memory: who refers to one goes on doing so. Nor is touched what is the
/// same, for a cycle may be reading it. Of what is added or taken back lists and whatever refers into them are written anew: no process of the
/// subsystem runs, and the guard reads none of them. Realtime: allocates.
void take_over(SubsystemDescriptor& flown, SubsystemDescriptor&& fresh);

}  // namespace hirosco::descriptor
