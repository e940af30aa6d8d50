// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

/// An event on its way from a subsystem to the supervisor (docs/adr/0020). It is no telemetry: TC[5,6] switches the
/// report to ground off, never this.
///
/// Octets: severity u8 (1 to 4), reported u8 (0 or 1), event id u16 (not 0), auxiliary data as in TM[5,x]; big-endian.
namespace hirosco::pus {

/// Whether a report of the same event follows.
enum class Reported : std::uint8_t { No = 0, Yes = 1 };

struct EventMessage {
  descriptor::Severity severity{descriptor::Severity::Info};
  Reported reported{Reported::Yes};
  std::uint16_t id{0};
  Octets auxiliary{};                ///< views the octets that it was read from
};

inline constexpr std::size_t event_message_head_octets = 4;
/// From here on the octets are the source data of the report.
inline constexpr std::size_t event_message_id_at = 2;

/// ResourceExhausted: the buffer is too small.  Realtime: bounded.
[[nodiscard]] Result<Octets> write_event_message(MutableOctets buffer, const EventMessage& event) noexcept;
/// Malformed: too short, no severity, or no id.  Realtime: wait-free.
[[nodiscard]] Result<EventMessage> read_event_message(Octets octets) noexcept;

}  // namespace hirosco::pus
