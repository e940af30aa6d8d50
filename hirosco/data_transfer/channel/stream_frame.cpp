// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/stream_frame.hpp"

#include "hirosco/utilities/crc16.hpp"

namespace hirosco {

Result<std::optional<StreamFrame>> read_stream_frame(Octets received) noexcept {
  OctetReader reader{received.first(std::min(received.size(), stream_frame_head_octets))};
  const auto magic = reader.get<std::uint16_t>();
  if (reader.good() && magic != stream_frame_magic) return fail(ErrorCode::Malformed, "beginning of a frame", magic);
  const auto theirs = reader.get<std::uint8_t>();
  if (reader.good() && theirs != stream_frame_version)
    return fail(ErrorCode::Mismatch, "another version of a member's stream; build both from one hirosco", theirs);
  const auto kind = reader.get<std::uint8_t>();
  if (reader.good() && (kind < static_cast<std::uint8_t>(StreamFrameKind::Message) ||
                        kind > static_cast<std::uint8_t>(StreamFrameKind::Permit)))
    return fail(ErrorCode::Malformed, "kind of frame", kind);
  const std::size_t payload = reader.get<std::uint16_t>();
  if (!reader.good()) return std::nullopt;
  if (payload > max_stream_frame_payload)
    return fail(ErrorCode::Malformed, "octets of frame", static_cast<std::int64_t>(payload));
  const std::size_t whole = payload + stream_frame_extra_octets;
  if (received.size() < whole) return std::nullopt;
  const std::size_t checked = stream_frame_head_octets + payload;
  const auto sum = OctetReader{received.subspan(checked, 2)}.get<std::uint16_t>();
  if (crc16(received.first(checked)) != sum) return fail(ErrorCode::Malformed, "check sum of frame", sum);
  return StreamFrame{static_cast<StreamFrameKind>(kind), received.subspan(stream_frame_head_octets, payload), whole};
}

Result<Octets> write_stream_frame(MutableOctets buffer, StreamFrameKind kind, Octets head, Octets rest) noexcept {
  const std::size_t payload = head.size() + rest.size();
  if (payload > max_stream_frame_payload)
    return fail(ErrorCode::InvalidArgument, "octets of frame", static_cast<std::int64_t>(payload));
  OctetWriter writer{buffer};
  writer.put(stream_frame_magic)
      .put(stream_frame_version)
      .put(static_cast<std::uint8_t>(kind))
      .put(static_cast<std::uint16_t>(payload))
      .put(head)
      .put(rest);
  writer.put(crc16(writer.written()));
  if (!writer.good()) return fail(ErrorCode::ResourceExhausted, "room for a frame");
  return writer.written();
}

}  // namespace hirosco
