// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/data_transfer/channel/channel.hpp"

/// The header of every message between processes, whatever carries it: kind u8, version u8, link u16, epoch u32
/// (big-endian); the packet follows. Both ends check the version of each message.
namespace hirosco::envelope {

inline constexpr std::size_t octets = 8;
/// Of this envelope and of what the kinds of messages mean.
inline constexpr std::uint8_t version = 1;

inline void write(OctetWriter& writer, const Message& message) noexcept {
  writer.put(static_cast<std::uint8_t>(message.kind)).put(version).put(message.link).put(message.epoch);
}

/// A message without its packet. Malformed: too short, or of no kind; Mismatch: of another version, which is the number.
[[nodiscard]] inline Result<Message> read(OctetReader& reader) noexcept {
  const auto kind = reader.get<std::uint8_t>();
  const auto theirs = reader.get<std::uint8_t>();
  Message message;
  message.link = reader.get<std::uint16_t>();
  message.epoch = reader.get<std::uint32_t>();
  if (!reader.good()) return fail(ErrorCode::Malformed, "message is too short");
  if (theirs != version)
    return fail(ErrorCode::Mismatch, "another version of the control channel; build both from one hirosco", theirs);
  if (kind < static_cast<std::uint8_t>(MessageKind::Packet) ||
      kind > static_cast<std::uint8_t>(MessageKind::PermitPage))
    return fail(ErrorCode::Malformed, "kind of message", kind);
  message.kind = static_cast<MessageKind>(kind);
  return message;
}

}  // namespace hirosco::envelope
