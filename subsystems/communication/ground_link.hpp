// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hirosco/pus/packet.hpp"
#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The rules of the ground link, without any socket (decisions 25 and 28).
namespace hirosco::communication {

/// Why a connection came to its end.
enum class CloseReason : std::uint8_t {
  PeerClosed,      ///< its own wish
  Version,         ///< header: packet version not 0
  NotTelecommand,  ///< header: a telemetry packet
  Length,          ///< header: shorter or longer than any telecommand
  Incomplete,      ///< a packet was not complete in time
  Slow,            ///< did not read its telemetry
  Evicted,         ///< silent, and somebody else needed the place
  SocketError,
};
inline constexpr std::size_t close_reasons = 8;

/// Cuts a stream into telecommand packets. An implausible header ends the stream for good: searching for the next
/// packet could find one that was embedded in another's data, and execute it.
/// What is handed on has a plausible header and its announced length; checksum and fields are the receiver's to judge.
/// Realtime: bounded, does not allocate. Thread: one.
class Deframer {
 public:
  explicit Deframer(Duration incomplete_limit = 2s) noexcept : limit_{incomplete_limit} {}

  /// Calls `take(Octets packet)` for each packet that is complete; idle packets are dropped and counted.
  /// The reason once the stream is spoilt: nothing is taken from it any more.
  template <class Take>
  std::optional<CloseReason> feed(Octets octets, TimePoint now, Take&& take);
  /// Incomplete when a packet has been waited for too long.
  [[nodiscard]] std::optional<CloseReason> check(TimePoint now) noexcept;
  /// When `check` will say so; empty between packets.
  [[nodiscard]] std::optional<TimePoint> deadline() const noexcept;
  [[nodiscard]] std::uint64_t idle_packets() const noexcept { return idle_; }

 private:
  /// Moves octets over until the packet has `wanted` of them.
  void collect(Octets& octets, std::size_t wanted) noexcept;
  [[nodiscard]] std::optional<CloseReason> judge_header() noexcept;

  Duration limit_;
  TimePoint begun_{};
  std::size_t size_{0};
  std::size_t whole_{0};
  std::uint64_t idle_{0};
  bool is_idle_{false};
  std::optional<CloseReason> spoilt_{};
  std::array<std::byte, pus::max_telecommand_octets> packet_{};
};

/// Number of a connection, never 0; not given again soon.
using ClientId = std::uint16_t;

/// 10015 gives all telemetry and takes telecommands, 10025 takes telecommands only.
enum class GroundPort : std::uint8_t { TelemetryAndTelecommands, TelecommandsOnly };

/// Who takes what comes from the ground.
struct GroundTraffic {
  virtual ~GroundTraffic() = default;
  /// `packet` is valid during the call; it may be damaged in all but its header. May call `telemetry`.
  virtual void telecommand(ClientId client, Octets packet) = 0;
};

struct ClientCounters {
  GroundPort port{};
  TimePoint admitted{};
  std::uint64_t packets{0};  ///< of plausible form
  std::uint64_t valid_packets{0};  ///< whole and undamaged
  std::uint64_t octets_received{0};
  std::uint64_t octets_sent{0};
};
struct LinkCounters {
  std::uint64_t clients{0};  ///< connected now
  std::uint64_t admitted{0};
  std::uint64_t refused{0};  ///< no place, and nobody to evict
  std::uint64_t packets{0};
  std::uint64_t valid_packets{0};
  std::uint64_t idle_packets{0};
  std::uint64_t telemetry_packets{0};
  std::array<std::uint64_t, close_reasons> closed{};  ///< by CloseReason
};

/// All clients of the link. Telemetry is kept once, in a ring that every client reads at its own pace; who falls behind
/// by more than the ring is cut, never waited for.
/// When all places are taken, the oldest client that has never sent a valid packet gives way; a pure listener keeps its
/// place by one ping. With nobody to evict, the newcomer is refused.
/// Realtime: bounded; memory is taken by the constructor. Thread: one.
class GroundClients {
 public:
  static constexpr std::size_t most_clients = 256;
  struct Limits {
    std::size_t clients{most_clients};
    std::size_t backlog_octets{1 << 20};  ///< telemetry that a client may leave unread
    Duration incomplete{2s};
  };
  struct Admission {
    ClientId client{};
    std::optional<ClientId> evicted{};  ///< its place is gone: close its connection
  };

  explicit GroundClients(const Limits& limits);

  /// ResourceExhausted: refused.
  [[nodiscard]] Result<Admission> admit(GroundPort port, TimePoint now);
  /// Octets from a client; whole packets go to `traffic`.
  void received(ClientId client, Octets octets, TimePoint now, GroundTraffic& traffic);
  /// Queues a packet for every client of the telemetry port. ResourceExhausted: longer than the backlog.
  Result<> telemetry(Octets packet);
  /// What may be sent to the client next, as far as it is in one piece; empty when it has everything.
  [[nodiscard]] Octets output(ClientId client) const noexcept;
  void sent(ClientId client, std::size_t octets) noexcept;
  /// Finds packets that are overdue; the next time to look.
  std::optional<TimePoint> step(TimePoint now) noexcept;
  /// The connection is to be closed for this reason; empty while it is welcome.
  [[nodiscard]] std::optional<CloseReason> condemned(ClientId client) const noexcept;
  /// The connection is closed; its own reason goes before `reason`.
  void remove(ClientId client, CloseReason reason) noexcept;

  [[nodiscard]] const ClientCounters* counters_of(ClientId client) const noexcept;
  [[nodiscard]] const LinkCounters& counters() const noexcept { return counters_; }
  /// Index below `most_clients`, unique among present clients.
  [[nodiscard]] static constexpr std::size_t place_of(ClientId client) noexcept { return client % most_clients; }

 private:
  struct Client {
    explicit Client(Duration incomplete) noexcept : deframer{incomplete} {}
    ClientId id{0};  ///< 0: free
    std::uint8_t generation{0};
    std::uint64_t order{0};
    std::uint64_t read_to{0};
    std::optional<CloseReason> condemned{};
    ClientCounters counters{};
    Deframer deframer;
  };
  [[nodiscard]] Client* find(ClientId client) noexcept;
  [[nodiscard]] const Client* find(ClientId client) const noexcept;
  [[nodiscard]] Client* free_place() noexcept;
  [[nodiscard]] Client* oldest_silent() noexcept;

  Limits limits_;
  std::vector<Client> clients_;
  std::vector<std::byte> ring_;
  std::uint64_t written_{0};
  std::uint64_t next_order_{0};
  LinkCounters counters_;
};

template <class Take>
std::optional<CloseReason> Deframer::feed(Octets octets, TimePoint now, Take&& take) {
  while (!spoilt_ && !octets.empty()) {
    if (size_ == 0) begun_ = now;
    if (size_ < pus::primary_header_octets) {
      collect(octets, pus::primary_header_octets);
      if (size_ < pus::primary_header_octets) break;
      spoilt_ = judge_header();
    }
    if (spoilt_) break;
    collect(octets, whole_);
    if (size_ < whole_) break;
    size_ = 0;
    if (is_idle_) ++idle_;
    else take(Octets{packet_}.first(whole_));
  }
  return spoilt_;
}

}  // namespace hirosco::communication

namespace hirosco {
template <>
struct EnumTexts<communication::CloseReason> {
  using enum communication::CloseReason;
  static constexpr auto table = enum_table<communication::CloseReason>({
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
