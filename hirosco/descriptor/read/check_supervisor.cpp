// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <string>
#include <string_view>

#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

/// What a subsystem may say and the supervisor, which is one, may not: nothing there is in force (docs/adr/0203).
namespace hirosco::descriptor::detail {
namespace {

struct NotOfSupervisor {
  std::string_view name;
  std::string_view instead;
};

constexpr std::array elements_of_others{
    NotOfSupervisor{"ServiceLoop", "its services run in its own loop"},
    NotOfSupervisor{"Bumpless", "its configuration stays"},
    NotOfSupervisor{"Device", "no code of it asks a device, and no guard would hold its actuators"},
    NotOfSupervisor{"Hang", "the guard counts a second of its own"}};
constexpr std::array attributes_of_others{
    NotOfSupervisor{"priority", "its thread has one of its own, below what moves and above ordinary work"},
    NotOfSupervisor{"spin_us", "its cycle spins for nobody"}};
constexpr std::array limits_of_others{"memory_kB", "shared_memory_kB",  "threads", "descriptors",
                                      "ports",     "processor_percent", "files"};

}  // namespace

void check_supervisor(const xml::Element& root, Problems& problems) {
  const auto refuse = [&](const xml::Element& element, std::string_view attribute, std::string_view instead) {
    const std::string hint = fmt::format("leave it out: {}", instead);
    if (attribute.empty())
      return problems.add(element, "E0332", fmt::format("<{}> is not built in for the supervisor", element.name), hint);
    if (const xml::Attribute* const at = element.find(attribute); at != nullptr)
      problems.add(*at, "E0332",
                   fmt::format("'{}' of <{}> is not built in for the supervisor", attribute, element.name), hint);
  };
  for (const xml::Element& child : root.children) {
    for (const auto& [name, instead] : elements_of_others)
      if (child.name == name) refuse(child, "", instead);
    for (const auto& [name, instead] : attributes_of_others)
      if (child.name == "Configuration") refuse(child, name, instead);
    for (const std::string_view limit : limits_of_others)
      if (child.name == "Resources") refuse(child, limit, "only whom it starts is limited");
  }
}

}  // namespace hirosco::descriptor::detail
