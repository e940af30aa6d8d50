// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::tools::doctor {

inline constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// A folder that a flight writes into.
struct Place {
  std::filesystem::path path;
  std::optional<std::string> why_not;  ///< what the system said to a file made there; empty: it was made
  std::uint64_t free_octets{0};
};

/// An address that a flight listens on.
struct Port {
  std::string address;
  std::optional<std::string> why_not;  ///< empty: it is free
  std::string flight;                  ///< of the registry, that listens there; empty: none
};

/// The world of robots that have a URDF file.
struct World {
  bool wanted{false};             ///< the mission has somebody in it
  std::string package;            ///< that has it; empty: no template says which world it is
  bool program{false};            ///< it is here
  std::filesystem::path library;  ///< its physics, which is fetched and not packaged; empty: not here
  std::string digest;             ///< SHA-256 of that
  std::string fetched;            ///< SHA-256 that it had when it was fetched and judged; empty: nobody knows
  std::string fetcher;            ///< the line that fetches it
};

/// What `hirosco doctor` judges: of this computer by look_at() of the command, of any other by a test.
struct System {
  std::string user;
  // Rights, asked as a flight asks for them.
  int highest_priority{0};                ///< of a flight, under SCHED_FIFO
  std::optional<Error> no_priority;       ///< what set_fifo_priority() said to it; empty: granted
  std::uint64_t priority_limit{0};        ///< RLIMIT_RTPRIO
  std::optional<Error> no_locked_memory;  ///< what lock_memory() said, of as much as a subsystem has
  std::uint64_t memory_limit{0};          ///< RLIMIT_MEMLOCK, octets
  std::vector<std::string> open;          ///< isolation_lacks()
  bool isolation_required{false};         ///< by the mission
  // Processors.
  unsigned processors{1};                          ///< that may be used
  unsigned cycle_processor{0};                     ///< that of all cycles
  double quota{0};                                 ///< processors that the control group may use; 0: no bound
  std::string group;                               ///< its file of that
  std::int64_t realtime_us{0}, realtime_of_us{1};  ///< of each period, for all of SCHED_FIFO; negative: all of it
  std::string governor;                            ///< of the cycles' processor; empty: none
  std::string kernel, preemption;                  ///< release; what of it says how it preempts
  bool realtime_kernel{false};                     ///< PREEMPT_RT
  // Clocks.
  std::string clock_source;
  Duration resolution{0};    ///< of the monotonic clock
  bool synchronised{false};  ///< the calendar, by the network or otherwise
  Duration timer_slack{0};
  std::vector<Duration> late;  ///< of sleeps, in order, at the rank of a cycle where that is granted
  // What a flight takes.
  std::vector<Place> places;
  std::vector<Port> ground_link;
  Port page;
  std::string mission;
  std::vector<std::string> not_ready;  ///< what the mission names and is not here
  bool station{false}, page_built{false};
  std::vector<std::string> no_tools;  ///< of those that build a subsystem and its test
  std::string builder;  ///< what cmake builds with: make, or ninja where there is no make
  // What it is made of.
  std::string version;                      ///< of this command, with its interface
  std::vector<std::string>
      other_versions;  ///< modules of the mission that this one does not take, in words: mostly of another
  std::filesystem::path development;        ///< the library that modules are built with, where it is installed
  std::string development_version;          ///< what it has for `version`
  std::vector<std::string> libraries;  ///< others' that this command runs with, by the names of their files
  std::vector<std::string> no_libraries;  ///< what modules of the mission want of others and have not, in words
  std::string python;                     ///< what python3 is called in full: "python3.11"; empty: there is none
  World world;
};

}  // namespace hirosco::tools::doctor
