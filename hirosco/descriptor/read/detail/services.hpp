// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"

namespace hirosco::descriptor::detail {

/// Octets of a housekeeping report that are left for samples: packet 4096 less headers, checksum and structure id.
inline constexpr std::size_t max_housekeeping_octets = 4096 - 22 - 2;
/// Octets of an event's arguments: the same packet less the event's id.
inline constexpr std::size_t max_event_octets = 4096 - 22 - 2;
/// Of one function, or of one event.
inline constexpr std::size_t max_arguments = 255;

/// Where the services under <Subsystem>, or under one <Configuration>, are read into.
struct Services {
  std::vector<HousekeepingStructure>& housekeeping;
  std::vector<Provides>& provides;
  std::vector<Requires>& requires_;
  Unique& structure_ids;
  Unique& provided;
  Unique& required;
  Duration& self_test_within;
  std::size_t configurations{0};  ///< that the subsystem has, where these are of one of them; else 0
  std::map<std::string, Location> seen{};
};

/// Functions and events stand under <Configuration> only where it is the only one.
void expect_for_all(const xml::Element& element, Problems& problems, const Services& services, std::string_view name);

}  // namespace hirosco::descriptor::detail
