// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"

/// TM[129,3] of the supervisor: a telecommand that it has received from a ground, the whole packet, to every ground.
/// Operators so see each other's telecommands by name and arguments; reports of service 1 carry a request id alone. It
/// comes before the first report on the telecommand, and for refused ones too.
namespace hirosco::supervisor {

/// One that is too long for a telemetry packet is not told.
inline void send_telecommand_copy(pus::TelemetrySink& sink, Octets packet) {
  if (packet.size() > pus::max_telemetry_octets - pus::telemetry_overhead_octets) return;
  sink.report(pus::st129::service_type, pus::st129::telecommand_copy, 0, packet);
}

}  // namespace hirosco::supervisor
