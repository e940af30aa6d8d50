// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Largest packet on a control channel, header and error control included.
inline constexpr std::size_t max_packet_octets = 4096;

/// What a control-channel message is about.
enum class MessageKind : std::uint8_t {
  Packet = 1,       ///< a space packet: to a subsystem a telecommand (or telemetry for the ground link), from it any
  GroundTelecommand = 2,  ///< from the ground link only: a telecommand that came from ground
  Event = 3,  ///< from a subsystem: it raised an event (pus/st05_event/event_message.hpp), reported to ground or not
  PermitPage = 4,  ///< to a subsystem: `memory` is its permit page from now on; from it, empty: it is in force
};

/// One message of the control channel between a subsystem and the supervisor: one space packet and, where the packet is
/// a link attachment, the handle of the link's memory; or one event.
struct Message {
  MessageKind kind{MessageKind::Packet};
  /// To a subsystem: the supervisor's mode epoch at permission, 0 = any (decision 27). From one, beside a telecommand: the newest stop of
  /// everything that was known before that was said (PermitPage::newest_stop), 0 = nobody knows (docs/adr/0156).
  std::uint32_t epoch{0};
  std::uint16_t link{0};  ///< ground link client that a GroundTelecommand came from; else 0
  Octets packet{};
  MemoryHandle memory{};  ///< usually empty
};

struct MessageBuffer {
  std::array<std::byte, max_packet_octets> octets;
};

/// Carries messages, in order, whole, both ways, without blocking (real: UNIX SOCK_SEQPACKET; simulated: a queue).
/// Thread: one per direction. Realtime: never used in a cycle.
class Channel {
 public:
  virtual ~Channel() = default;
  /// ResourceExhausted: the peer does not read; nothing was sent. Unavailable: the peer is gone.
  [[nodiscard]] virtual Result<> send(const Message& message) = 0;
  /// Sends as many as the peer takes now, in order, and answers how many: for who has several at once. What stopped it is
  /// what send() says of the next one.
  [[nodiscard]] virtual std::size_t send_all(std::span<const Message> messages) {
    std::size_t sent = 0;
    while (sent < messages.size() && send(messages[sent])) ++sent;
    return sent;
  }
  /// Next message into `buffer`; Flow::None in `found` when there is none. Unavailable: the peer is gone and all is read.
  struct Found {
    Flow flow{Flow::None};
    Message message;  ///< `packet` views `buffer`
  };
  [[nodiscard]] virtual Result<Found> receive(MessageBuffer& buffer) = 0;
  /// What waits for the peer, and with how much send() refuses, both in a unit of the channel's own. `room` 0: nobody can tell.
  struct Fill {
    std::uint64_t used{0};
    std::uint64_t room{0};
  };
  [[nodiscard]] virtual Fill outbound() noexcept { return {}; }
  /// Descriptor to poll for readability, -1 where there is none (simulated).
  [[nodiscard]] virtual int wait_descriptor() const noexcept { return -1; }
};

}  // namespace hirosco
