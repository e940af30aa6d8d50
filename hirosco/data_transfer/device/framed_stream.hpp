// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/stream_framing.hpp"

namespace hirosco {

/// Frames, or an author's octets, through a descriptor that carries octets in order and does not block. Which one it is may change:
/// restart() then.  Realtime: bounded, no allocation. Thread: one.
class FramedStream {
 public:
  enum class Carrier : std::uint8_t { Socket, Line };
  FramedStream(Carrier carrier, Framing framing) noexcept : carrier_{carrier}, framing_{framing} {}

  /// Unavailable with errno: the peer is gone; without: it does not read, and the frame is let go. What was begun of an earlier one
  /// goes first, so that a stream has whole frames only.
  [[nodiscard]] Result<> send(int descriptor, Octets frame) noexcept;
  /// As DataFlow::receive(); at most most_reads of the system.
  [[nodiscard]] Result<Received> receive(int descriptor, MutableOctets buffer) noexcept;
  void restart() noexcept;

  static constexpr int most_reads = 4;

 private:
  [[nodiscard]] Result<> flush(int descriptor) noexcept;
  [[nodiscard]] Result<std::size_t> read(int descriptor, MutableOctets room) noexcept;
  [[nodiscard]] Result<Received> receive_octets(int descriptor, MutableOctets buffer) noexcept;

  Carrier carrier_;
  Framing framing_;
  StreamDeframer deframer_;
  std::array<std::byte, max_streamed_octets> out_;
  std::size_t out_begin_{0};  ///< of what is still to go
  std::size_t out_end_{0};
};

}  // namespace hirosco
