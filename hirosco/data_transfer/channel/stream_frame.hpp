// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "hirosco/data_transfer/channel/envelope.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

/// How a member that shares no memory with its supervisor speaks with it over a stream of octets: magic u16, version u8, kind
/// u8, octets of the payload u16 (big-endian), payload, CRC-16 over all before it.
namespace hirosco {

inline constexpr std::uint16_t stream_frame_magic = 0x484D;  // "HM"
/// Of the frames and of all payloads but messages, whose envelope has a version of its own.
inline constexpr std::uint8_t stream_frame_version = 2;

enum class StreamFrameKind : std::uint8_t {
  Message = 1,  ///< either way: envelope and packet
  Vital = 2,  ///< from the member: what its vital page says (hirosco/subsystem/pages/page_words.hpp)
  Permit = 3,  ///< to the member: what its permit page has to say
};

inline constexpr std::size_t stream_frame_head_octets = 6;
inline constexpr std::size_t stream_frame_extra_octets = stream_frame_head_octets + 2;  ///< head and check sum
inline constexpr std::size_t max_stream_frame_payload = envelope::octets + max_packet_octets;
inline constexpr std::size_t max_stream_frame_octets = max_stream_frame_payload + stream_frame_extra_octets;

struct StreamFrame {
  StreamFrameKind kind{};
  Octets payload;
  std::size_t octets{0};  ///< of the whole frame: the next one begins behind them
};

/// The frame at the beginning of what was received; empty: more octets are needed. What is wrong is said as soon as it can be
/// seen. Malformed: no frame, or a damaged one; Mismatch: one of another version, which is the number. A stream in which
/// that happened has no place from which to go on.
/// Realtime: bounded. Thread: any.
[[nodiscard]] Result<std::optional<StreamFrame>> read_stream_frame(Octets received) noexcept;

/// A frame around head and rest of its payload; nothing is written where it does not fit.
[[nodiscard]] Result<Octets> write_stream_frame(MutableOctets buffer, StreamFrameKind kind, Octets head,
                                                Octets rest = {}) noexcept;

}  // namespace hirosco
