// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/xtce.hpp"

#include "ground/clients/xtce/service_reports.hpp"
#include "hirosco/utilities/version.hpp"

namespace hirosco::ground {

Xtce xtce(const Catalogue& catalogue) {
  Xtce result;
  result.name = XtceNames{}.unique(catalogue.mission().name);
  SpaceSystem system{
      result.name, "",
      "The mission " + catalogue.mission().name + ", from its descriptors: export it again rather than change it"};
  TypeSet types{TypeSet::Of::Parameters, system.path()};
  TypeSet argument_types{TypeSet::Of::Arguments, system.path()};
  const PacketRoot root = add_packet_root(system, types, catalogue);
  const std::string telecommand = add_telecommand(system, argument_types);
  add_service_reports(system, types, root);
  for (const auto* subsystem : catalogue.subsystems()) {
    SpaceSystem& place = system.add_system(subsystem->name, subsystem->description);
    const std::string failure = add_failure_of(place, types, root, *subsystem);
    result.arguments.push_back(add_subsystem_reports(place, types, root, catalogue, *subsystem));
    result.commands.push_back(add_commands(place, argument_types, root, catalogue, *subsystem, telecommand, failure));
  }
  result.event_id = root.event_id;
  result.events = event_names(catalogue);
  Element header{"Header", {{"version", std::string{version}}, {"validationStatus", "Working"}}};
  Element document = system.element(types.elements(), argument_types.elements(), {std::move(header)});
  document.attributes.insert(document.attributes.begin(), {"xmlns", "http://www.omg.org/spec/XTCE/20180204"});
  result.text = xml_document(document);
  return result;
}

}  // namespace hirosco::ground
