// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// Longest frame of a flow, whatever its means.
inline constexpr std::size_t max_frame_octets = 1024;

/// What a receive found.
struct Received {
  Flow flow{Flow::None};
  std::size_t octets{0};             ///< of the buffer that were filled
  std::uint32_t damaged{0};  ///< places since the last receive where a stream was damaged; datagrams have none
};

/// Any means of communication with a device (paper 4.1): whole frames, both ways, never blocking.
/// Realtime: bounded, no allocation, no system call that waits. At the end of a subsystem these at most, to receive and to send: shared memory none and 1, which
/// wakes a peer that waits; UNIX and UDP 16 and 1; message queue 16 and 4; TCP and serial line 4 and 3; by an author's protocol (FrameProtocol)
/// four times as many to receive. Who looks for a peer that has gone does so at most each reconnect_pause, by those that open a flow.
/// Thread: the one user.
class DataFlow {
 public:
  virtual ~DataFlow() = default;
  /// Hands one frame over. Unavailable: nobody listens or no room; the frame is gone. OutOfRange: it is longer than
  /// max_frame_octets.
  [[nodiscard]] Result<> send(Octets frame) noexcept { return do_send(frame); }
  /// Newest frame if one came since the last call. Unavailable: the peer is gone (hang-up); a flow
  /// without connection reports that after the next send. Malformed: a frame came that is longer than `buffer`; it is
  /// gone.
  [[nodiscard]] Result<Received> receive(MutableOctets buffer) noexcept { return do_receive(buffer); }
  /// Waits until a frame may be there, at most `timeout`; false on timeout. Blocks: never in a cycle.
  [[nodiscard]] bool wait(Duration timeout) noexcept { return do_wait(timeout); }

 private:
  [[nodiscard]] virtual Result<> do_send(Octets frame) noexcept = 0;
  [[nodiscard]] virtual Result<Received> do_receive(MutableOctets buffer) noexcept = 0;
  [[nodiscard]] virtual bool do_wait(Duration timeout) noexcept = 0;
};

/// How frames travel between a subsystem and a device.
enum class Transfer : std::uint8_t { SharedMemory, MessageQueue, Unix, Udp, Tcp, Serial, Can, Ethercat };
template <>
struct EnumTexts<Transfer> {
  using enum Transfer;
  static constexpr auto table = enum_table<Transfer>({{SharedMemory, "shared_memory"},
                                                      {MessageQueue, "message_queue"},
                                                      {Unix, "unix"},
                                                      {Udp, "udp"},
                                                      {Tcp, "tcp"},
                                                      {Serial, "serial"},
                                                      {Can, "can"},
                                                      {Ethercat, "ethercat"}});
};

/// Which end of a flow is opened: the subsystem's or the device's.
enum class FlowSide : std::uint8_t { Subsystem, Device };

/// What a flow carries: device frames, or the octets of an author's own protocol (FrameProtocol), which a stream hands on as
/// they come.
enum class Framing : std::uint8_t { Frames, Raw };
template <>
struct EnumTexts<Framing> {
  static constexpr auto table = enum_table<Framing>({{Framing::Frames, "frames"}, {Framing::Raw, "raw"}});
};

/// Who holds the subsystem's end of a flow: the subsystem itself, or the supervisor's side alone, as second inhibits and power switches
/// are. What is the supervisor's is where no sandbox lets a subsystem in (docs/adr/0150).
enum class FlowHolder : std::uint8_t { Subsystem, Supervisor };

/// A flow that lost its peer looks for it no more often than this.
inline constexpr Duration reconnect_pause = std::chrono::milliseconds{50};

/// The part of an endnode descriptor that a flow needs.
struct FlowAddress {
  Transfer transfer{};
  std::string address;  ///< a name, a line, or host:port
  Framing framing{Framing::Frames};
  FlowHolder holder{FlowHolder::Subsystem};
};

/// Opens data flows. Real: by means of transfer; simulated: a pair of mailboxes in memory.  Realtime: allocates.
class FlowFactory {
 public:
  virtual ~FlowFactory() = default;
  [[nodiscard]] Result<std::unique_ptr<DataFlow>> open(const FlowAddress& address, FlowSide side) {
    return do_open(address, side);
  }

 private:
  [[nodiscard]] virtual Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide side) = 0;
};

}  // namespace hirosco
