// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st05_event/event_message.hpp"

namespace hirosco::pus {

Result<Octets> write_event_message(MutableOctets buffer, const EventMessage& event) noexcept {
  OctetWriter writer{buffer};
  writer.put(static_cast<std::uint8_t>(event.severity));
  writer.put(static_cast<std::uint8_t>(event.reported));
  writer.put(event.id).put(event.auxiliary);
  if (!writer.good())
    return fail(ErrorCode::ResourceExhausted, "buffer of an event", static_cast<std::int64_t>(buffer.size()));
  return writer.written();
}

Result<EventMessage> read_event_message(Octets octets) noexcept {
  OctetReader reader{octets};
  const auto severity = reader.get<std::uint8_t>();
  const auto reported = reader.get<std::uint8_t>();
  EventMessage event;
  event.id = reader.get<std::uint16_t>();
  if (!reader.good()) return fail(ErrorCode::Malformed, "length of an event", static_cast<std::int64_t>(octets.size()));
  if (severity < static_cast<std::uint8_t>(descriptor::Severity::Info) ||
      severity > static_cast<std::uint8_t>(descriptor::Severity::High))
    return fail(ErrorCode::Malformed, "severity of an event", severity);
  if (reported > static_cast<std::uint8_t>(Reported::Yes))
    return fail(ErrorCode::Malformed, "is an event reported?", reported);
  if (event.id == 0) return fail(ErrorCode::Malformed, "id of an event");
  event.severity = static_cast<descriptor::Severity>(severity);
  event.reported = static_cast<Reported>(reported);
  event.auxiliary = octets.subspan(event_message_head_octets);
  return event;
}

}  // namespace hirosco::pus
