// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"

namespace hirosco {

/// The protocol of a device that speaks no device frames, by an author (`framing="raw"` of an endnode, docs/adr/0112): octets out for
/// each command, and what the octets that came say. It is called in the cycle: noexcept, no allocation, no lock, no I/O, bounded.
/// Thread: the cycle.
class FrameProtocol {
 public:
  /// What was found in octets that came.
  struct Heard {
    bool whole{false};  ///< a message was complete; of several the newest
    std::uint16_t flags{0};  ///< device_flag
    Octets
        payload{};  ///< its values as the fields of <Input> lie, in the endnode's byte order; views memory of the protocol
    std::uint32_t damaged{0};  ///< messages that were damaged
  };
  virtual ~FrameProtocol() = default;
  /// What goes out for a command, whose payload lies as the fields of <Output>: into `out`, as many octets as are returned; 0: nothing now.
  /// `command.mode` says what of it may move: Off and Stop are orders, too.
  [[nodiscard]] virtual std::size_t say(const DeviceCommand& command, MutableOctets out) noexcept = 0;
  /// What came since, at most max_frame_octets at a time: of a stream in pieces as they came, of datagrams each by itself.
  [[nodiscard]] virtual Heard hear(Octets came) noexcept = 0;
  /// Another connection begins: what was begun will not be ended.
  virtual void restart() noexcept = 0;
};

/// Device frames for whoever cycles, octets of the protocol on `wire`, which was opened with Framing::Raw. A status answers the newest
/// command when a whole message came after it. `protocol` must outlive it.
[[nodiscard]] std::unique_ptr<DataFlow> make_raw_flow(std::unique_ptr<DataFlow> wire, FrameProtocol& protocol);

}  // namespace hirosco
