// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "hirosco/subsystem/author/service_wake.hpp"
#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// Where the subsystem that holds a mission's ground link, whichever that is, meets what carries its packets (docs/adr/0154).
namespace hirosco {

/// In the environment of that subsystem: HOST:PORT at which it listens, as `<Ground>` of the mission and the instance of the
/// flight have it (adr 0037).
inline constexpr const char* telemetry_address_variable = "HIROSCO_TELEMETRY_ADDRESS";
inline constexpr const char* telecommand_address_variable = "HIROSCO_TELECOMMAND_ADDRESS";

/// Who takes what comes from the ground: that subsystem.
struct GroundTraffic {
  /// Number of a connection, never 0; not given again soon.
  using ClientId = std::uint16_t;
  /// What becomes of a packet that is offered: it stays with its client until it is taken.
  enum class Taken : std::uint8_t { Yes, Later };
  /// When it was said, as far as is known: behind the newest GroundTransport::all_stopped(), or perhaps before.
  enum class Said : std::uint8_t { Since, PerhapsBefore };

  virtual ~GroundTraffic() = default;
  /// `packet` is valid during the call; it may be damaged in all but its header. May call `GroundTransport::telemetry`.
  [[nodiscard]] virtual Taken telecommand(ClientId client, Octets packet, Said said) = 0;
};

/// What carries the packets of the ground link: real sockets, or a simulated ground. It is closed by its destructor.
/// Thread: the service loop.
class GroundTransport {
 public:
  /// Why a connection came to its end.
  enum class CloseReason : std::uint8_t {
    PeerClosed,  ///< its own wish
    Version,  ///< header: packet version not 0
    NotTelecommand,  ///< header: a telemetry packet
    Length,  ///< header: shorter or longer than any telecommand
    Incomplete,  ///< a packet was not complete in time, or cut off by the end of the stream
    Slow,  ///< did not read its telemetry
    Evicted,  ///< silent, and somebody else needed the place
    SocketError,
  };
  static constexpr std::size_t close_reasons = 8;

  /// Every packet that a client sent is one of `packets`, one of `idle_packets`, or the one at which its connection was
  /// `closed` for a reason of its stream; every connection is one of `clients` or one of `closed`.
  struct Counters {
    std::uint64_t clients{0};  ///< connected now
    std::uint64_t admitted{0};
    std::uint64_t refused{0};  ///< no place, and nobody to evict
    std::uint64_t packets{0};
    std::uint64_t valid_packets{0};
    std::uint64_t idle_packets{0};
    std::uint64_t held_back{0};  ///< times that a packet was offered and had to stay
    std::uint64_t telemetry_packets{0};
    std::array<std::uint64_t, close_reasons> closed{};  ///< by CloseReason
  };

  virtual ~GroundTransport() = default;
  /// Everything was stopped: what has come until now was perhaps said before that, and is offered as such, whether it was read from a socket
  /// or not. Called before the step that follows.
  virtual void all_stopped() = 0;
  /// Moves what is due; never blocks.
  virtual void step(TimePoint now) = 0;
  /// The link is to be closed: nothing more comes in, what has come is handed over. How many packets still wait for that.
  [[nodiscard]] virtual std::size_t finish(TimePoint now) = 0;
  /// Queues a packet for every telemetry client.
  virtual void telemetry(Octets packet) = 0;
  [[nodiscard]] virtual const Counters& counters() const = 0;
  /// When `step` is to be called besides.
  [[nodiscard]] virtual ServiceWake wake() const { return {}; }
};

/// Opens a transport that hands telecommands to `traffic`, which outlives it; called when a configuration is applied and none is open.
using OpenGroundTransport = std::function<Result<std::unique_ptr<GroundTransport>>(GroundTraffic& traffic)>;

template <>
struct EnumTexts<GroundTransport::CloseReason> {
  using enum GroundTransport::CloseReason;
  static constexpr auto table = enum_table<GroundTransport::CloseReason>({
      {PeerClosed, "closed by the client"},
      {Version, "packet version"},
      {NotTelecommand, "not a telecommand"},
      {Length, "packet length"},
      {Incomplete, "incomplete packet"},
      {Slow, "too slow"},
      {Evicted, "silent"},
      {SocketError, "connection error"},
  });
};

}  // namespace hirosco
