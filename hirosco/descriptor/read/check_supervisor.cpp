// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>
#include <string_view>

#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

/// What a subsystem may say and the supervisor, which is one, may not: nothing there is in force (docs/adr/0203, 0213).
namespace hirosco::descriptor::detail {
namespace {

struct NotOfSupervisor {
  std::string_view element;
  std::string_view attribute;  ///< empty: the element itself, with all that it has
  std::string_view instead;
};

constexpr std::string_view one_loop = "its services run in its own loop";
constexpr std::string_view no_link = "no link of a mission begins or ends at it";
constexpr std::string_view limits_of_others = "only whom it starts is limited";
constexpr std::string_view no_self_test = "it has no self test, and commissions itself without one";

/// What else stands in subsystem.xsd is in force for it as for everybody, and docs/adr/0213 says by what.
constexpr NotOfSupervisor not_in_force[]{
    {"ServiceLoop", "", one_loop},
    {"Service", "loop", one_loop},
    {"Bumpless", "", "its configuration stays"},
    {"Device", "", "no code of it asks a device, and no guard would hold its actuators"},
    {"Hang", "", "the guard counts a second of its own"},
    {"Commands", "", "it commands whom it likes, by its modes and plans"},
    {"Subscribes", "", "it reads all reports anyway, and none is passed on to it"},
    {"Script", "", "nobody in it plays scripts"},
    {"CustomService", "", "no code of it answers requests of one"},
    {"Failure", "", "no code of it fails with a code of its own"},
    {"RealTimeLinkService", "", no_link},
    {"Configuration", "priority", "its thread has one of its own, below what moves and above ordinary work"},
    {"Configuration", "spin_us", "its cycle spins for nobody"},
    {"Configuration", "started_by", no_link},
    {"Configuration", "self_test", no_self_test},
    {"TestService", "self_test_within_ms", no_self_test},
    {"ParamRef", "persistent", "nobody stores values of it"},
    {"StructRef", "persistent", "nobody stores values of it"},
    {"ParamRef", "from", "reports of others are not passed on to it"},
    {"StructRef", "from", "reports of others are not passed on to it"},
    {"Function", "sets", "who goes on for it is Operational whatever it ran"},
    {"Resources", "memory_kB", limits_of_others},
    {"Resources", "shared_memory_kB", limits_of_others},
    {"Resources", "threads", limits_of_others},
    {"Resources", "descriptors", limits_of_others},
    {"Resources", "processor_percent", limits_of_others},
    {"Resources", "ports", limits_of_others},
    {"Resources", "files", limits_of_others},
    {"Resources", "loop_reports_kB", one_loop},
    {"Resources", "channel_kB", "it is at the other end of each channel"},
    {"Pool", "", "no code of it takes a block"},
};

}  // namespace

void check_supervisor(const xml::Element& element, Problems& problems) {
  for (const xml::Element& child : element.children) {
    bool refused = false;
    for (const auto& [name, attribute, instead] : not_in_force) {
      if (child.name != name) continue;
      const std::string hint = fmt::format("leave it out: {}", instead);
      if (attribute.empty()) {
        refused = true;
        problems.add(child, "E0332", fmt::format("<{}> is not built in for the supervisor", name), hint);
      } else if (const xml::Attribute* const at = child.find(attribute); at != nullptr) {
        problems.add(*at, "E0332", fmt::format("'{}' of <{}> is not built in for the supervisor", attribute, name),
                     hint);
      }
    }
    if (!refused) check_supervisor(child, problems);
  }
}

}  // namespace hirosco::descriptor::detail
