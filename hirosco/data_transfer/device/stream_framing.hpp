// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/utilities/octets.hpp"

/// How frames lie in a stream of octets (serial line, TCP), which has no boundaries of its own and may lose, change or add some.
/// Little endian:  sync u16 | octets of the frame u16 | CRC-16/CCITT-FALSE u16 of the four before | frame | CRC-16 u16 of the frame.
/// The head has a check of its own: a length that was damaged would else swallow what follows.
namespace hirosco {

inline constexpr std::uint16_t stream_sync = 0x5348;  ///< "HS" in memory, 'SH' as a number
inline constexpr std::size_t stream_head_octets = 6;
inline constexpr std::size_t stream_overhead_octets = stream_head_octets + 2;
inline constexpr std::size_t max_streamed_octets = max_frame_octets + stream_overhead_octets;

/// The frame as it goes into a stream; empty: it is longer than max_frame_octets, or `buffer` has no room.
/// Realtime: bounded. Thread: any.
[[nodiscard]] Octets write_streamed(MutableOctets buffer, Octets frame) noexcept;

/// Finds whole frames in what comes out of a stream, and its place again after damage: what is no head is passed over octet by
/// octet, and a frame with a wrong check is looked into for the next head, once. So each octet is checked twice at most.
/// Realtime: bounded by `capacity`, no allocation. Thread: one.
class StreamDeframer {
 public:
  static constexpr std::size_t capacity = 4 * 1024;
  static_assert(capacity >= 2 * max_streamed_octets);

  /// Where the next octets of the stream go: not empty once next() has found nothing. What next() returned is gone.
  [[nodiscard]] MutableOctets room() noexcept;
  /// So many came there.
  void received(std::size_t octets) noexcept { end_ += octets; }
  /// The next whole frame; empty: more octets are needed. Views the buffer until room().
  [[nodiscard]] std::optional<Octets> next() noexcept;
  /// Places in the stream where it was damaged, since the last call: a frame with a wrong check, or octets that belong to none.
  [[nodiscard]] std::uint32_t take_damaged() noexcept;
  /// Another stream begins.
  void restart() noexcept;

 private:
  void skip_to_sync() noexcept;

  std::array<std::byte, capacity> buffer_;
  std::size_t begin_{0};  ///< of what was not looked at yet
  std::size_t end_{0};
  std::size_t suspect_end_{0};  ///< of a damaged frame that is being looked into
  std::uint32_t damaged_{0};
  bool lost_{false};  ///< passing over octets that belong to no frame
};

}  // namespace hirosco
