// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "ground/clients/xtce/space_system.hpp"
#include "ground/clients/xtce/types.hpp"
#include "ground/model/catalogue.hpp"

/// What every packet of telemetry has in front, and the reports of service 1, which are about requests of everybody.
namespace hirosco::ground {

/// Source id of whoever commands by an exported database: reports to it alone verify its commands.
inline constexpr std::uint16_t exported_source = 0x1000;
/// Where the data of a report begin, and what a report without data counts in its length field.
inline constexpr unsigned data_bit = 160;
inline constexpr unsigned length_without_data = 15;

/// Names of the events of a mission: one for each id, whoever reports it.
using EventNames = std::map<std::uint16_t, std::string>;
[[nodiscard]] EventNames event_names(const Catalogue& catalogue);

/// Paths of what the other parts of the database refer to.
struct PacketRoot {
  std::string apid, packet_length, service, subtype, destination;
  std::string telemetry;  ///< container of all reports
  std::string housekeeping, structure_id;
  std::string event, event_id;
  std::string verification;  ///< container of reports of service 1 to the source above
  std::string verified_apid, verified_count, verified_subtype;
  std::string crc;
};
/// What is as long as `octets` of data.
[[nodiscard]] Condition with_data(const PacketRoot& root, std::size_t octets, std::string comparison = "==");
/// Fills the root of the database.
[[nodiscard]] PacketRoot add_packet_root(SpaceSystem& system, TypeSet& types, const Catalogue& catalogue);

/// The code of whatever service 1 says has failed of a subsystem's requests, by its own names. Returns its parameter.
[[nodiscard]] std::string add_failure_of(SpaceSystem& system, TypeSet& types, const PacketRoot& root,
                                         const descriptor::SubsystemDescriptor& subsystem);

}  // namespace hirosco::ground
