// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "hirosco/descriptor/model/location.hpp"
#include "hirosco/utilities/time.hpp"

/// Which services a subsystem offers, and in which loops they run (docs/adr/0096). Plain data, as the descriptor says it.
namespace hirosco::descriptor {

/// Lowest type of a service of a subsystem's own: those below are the standard's and the framework's.
inline constexpr std::uint8_t first_custom_service = 192;
/// Most loops that a subsystem has besides its service loop and its cycle.
inline constexpr std::size_t max_service_loops = 8;
/// Most requests that wait in one of them.
inline constexpr std::uint32_t max_service_queue = 64;

/// A loop of its own for services: stepped in its own thread at its own period and priority. A configuration may say period, priority
/// and budget otherwise (docs/adr/0207): then it has one of the same name, whole.
struct ServiceLoop {
  std::string name;
  Duration period{};  ///< 1 ms to 1 s
  int priority{0};  ///< SCHED_FIFO, on the processor of the cycles; 0 = ordinary scheduling
  Duration budget{};  ///< most processor time of a step; 0 = not declared
  std::uint32_t queue{16};  ///< requests that wait at once
  Location at{};
};

/// What <Service> says of one service, the framework's or the subsystem's own.
struct ServiceUse {
  std::uint8_t type{};
  bool offered{true};
  int loop{-1};  ///< index into SubsystemDescriptor::service_loops; -1: the subsystem's service loop
  Location at{};
};

/// A service of the framework that a descriptor may leave out, by the name that it has there. The others are every
/// subsystem's, in its service loop: they need no row here (docs/adr/0196).
struct StandardService {
  std::string_view name;
  std::uint8_t type;
  bool may_have_loop;  ///< of the others why_no_loop() says why
};
inline constexpr std::array standard_services_by_name{
    StandardService{"ST03", 3, true}, StandardService{"ST05", 5, false}, StandardService{"ST20", 20, true}};

/// A service of the framework that stays in its subsystem's service loop, and why, for whoever asks otherwise (docs/adr/0200).
struct StaysInServiceLoop {
  std::string_view name;
  std::string_view because;
};
inline constexpr std::array stays_in_service_loop{
    StaysInServiceLoop{"ST01", "nobody asks it anything, and each loop verifies what its own services are asked"},
    StaysInServiceLoop{"ST05", "every event of every loop is told by the service loop, which asks it each time"},
    StaysInServiceLoop{"ST08", "states and calls reach the cycle in their order, by a queue with one writer"},
    StaysInServiceLoop{"ST17", "its answer says that the service loop lives; self tests go by a queue with one writer"},
    StaysInServiceLoop{"ST128", "the cycle is given its links, and gives them back, by a queue with one writer"},
    StaysInServiceLoop{"ST129", "the supervisor alone answers it, and has one loop"},
    StaysInServiceLoop{"ST130", "it changes what all loops read, which rest meanwhile"}};

/// Of one by its name; of one that comes later and may not be left out, the same for all.
[[nodiscard]] constexpr std::string_view why_no_loop(std::string_view name) noexcept {
  const auto found = std::ranges::find(stays_in_service_loop, name, &StaysInServiceLoop::name);
  return found != stays_in_service_loop.end() ? found->because : "it is made for the service loop";
}

/// "ST08": whether it has the form of such a name.
[[nodiscard]] constexpr bool is_standard_service_name(std::string_view name) noexcept {
  return name.starts_with("ST") && name.size() >= 4 && name.size() <= 5 &&
         name.find_first_not_of("0123456789", 2) == std::string_view::npos && (name.size() == 4 || name[2] != '0');
}

}  // namespace hirosco::descriptor
