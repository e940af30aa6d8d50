// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/packet/packet.hpp"

/// Packets in words, by the descriptors of a mission: for logs, consoles and tools. Never for decisions.
namespace hirosco::pus {

/// Words in octets of a fixed number: up to the first zero, what is not printable ASCII as '?'.
[[nodiscard]] std::string text_of(Octets octets);

class PacketDescriber {
 public:
  /// `mission` outlives the describer.
  explicit PacketDescriber(const descriptor::Mission& mission) : mission_{&mission} {}
  /// "TC[8,1] ARM SET_STATE STATE=4", "TM[5,3] ARM medium TORQUE_LIMIT_EXCEEDED JOINT=2 VALUE=12.1 N m …".
  /// Says what can be said of a damaged packet too.  Realtime: allocates.
  [[nodiscard]] std::string describe(Octets packet) const;
  /// "TORQUE_LIMIT_EXCEEDED JOINT=2 VALUE=12.1 N m LIMIT=12 N m" of the source data of TM[5,x].
  [[nodiscard]] std::string describe_event(std::uint16_t apid, Octets source_data) const;
  /// "value not acceptable KP", "SENSOR_BROKEN 'no answer' 42": a failure code of a report of service 1 from `apid`, and its data.
  [[nodiscard]] std::string describe_failure(std::uint16_t apid, std::uint16_t code, Octets data) const;
  /// Name of the subsystem, "APID 77" when the mission has none.
  [[nodiscard]] std::string name_of(std::uint16_t apid) const;

 private:
  [[nodiscard]] const descriptor::SubsystemDescriptor* find(std::uint16_t apid) const;
  [[nodiscard]] std::string refused_parameter(FailureCode code, Octets data) const;
  [[nodiscard]] std::string describe_telecommand(const TelecommandView& telecommand) const;
  [[nodiscard]] std::string describe_telemetry(const TelemetryView& telemetry) const;
  const descriptor::Mission* mission_;
};

}  // namespace hirosco::pus
