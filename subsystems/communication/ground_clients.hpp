// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/subsystem/author/ground_transport.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "subsystems/communication/telemetry_ring.hpp"
#include "subsystems/communication/turns.hpp"

/// The clients of the ground link and what they send, without any socket (decisions 25 and 28).
namespace hirosco::communication {

// Words of what the rules stand between.
using CloseReason = GroundTransport::CloseReason;
using LinkCounters = GroundTransport::Counters;
using ClientId = GroundTraffic::ClientId;
using Taken = GroundTraffic::Taken;
using Said = GroundTraffic::Said;

/// Cuts a stream into telecommand packets and keeps them until somebody takes them. An implausible header ends the
/// stream for good: searching for the next packet could find one that was embedded in another's data, and execute it.
/// What is handed on has a plausible header and its announced length; checksum and fields are the receiver's to judge.
/// Realtime: bounded, does not allocate. Thread: one.
class Deframer {
 public:
  /// The longest packet fits, however little of the buffer the one before it left.
  static constexpr std::size_t capacity = pus::max_telecommand_octets;

  explicit Deframer(Duration incomplete_limit = 2s) noexcept : limit_{incomplete_limit} {}

  /// Where the next octets of the stream belong; empty while it is full of packets that wait, and once it has ended.
  [[nodiscard]] MutableOctets room() noexcept;
  /// So many octets were put there.
  void put(std::size_t octets, TimePoint now) noexcept;
  /// The stream ends here: what is incomplete stays so.
  void end() noexcept;
  /// The oldest whole packet; empty when there is none. Idle packets are dropped and counted.
  [[nodiscard]] Octets front() const noexcept { return Octets{buffer_}.subspan(begin_, whole_); }
  /// Octets that were put there and have not been taken, or dropped.
  [[nodiscard]] std::size_t held_octets() const noexcept { return end_ - begin_; }
  /// How many whole packets wait, idle ones not counted.
  [[nodiscard]] std::size_t waiting() const noexcept;
  /// That packet has been taken.
  void pop(TimePoint now) noexcept;
  /// Incomplete when a packet has been waited for too long; not while whole ones before it wait to be taken.
  void check(TimePoint now) noexcept;
  /// When `check` will say so; empty between packets.
  [[nodiscard]] std::optional<TimePoint> deadline() const noexcept;
  /// The reason once the stream is spoilt: nothing is taken from it any more.
  [[nodiscard]] std::optional<CloseReason> spoilt() const noexcept { return spoilt_; }
  [[nodiscard]] std::uint64_t idle_packets() const noexcept { return idle_; }

 private:
  void look(TimePoint now) noexcept;
  void spoil(CloseReason reason) noexcept;

  Duration limit_;
  TimePoint begun_{};      ///< of the incomplete packet in front
  std::size_t begin_{0};
  std::size_t end_{0};
  std::size_t whole_{0};   ///< octets of the whole packet in front, 0 = none
  std::uint64_t idle_{0};
  bool ended_{false};
  std::optional<CloseReason> spoilt_{};
  std::array<std::byte, capacity> buffer_{};
};

/// 10015 gives all telemetry and takes telecommands, 10025 takes telecommands only.
enum class GroundPort : std::uint8_t { TelemetryAndTelecommands, TelecommandsOnly };

struct ClientCounters {
  GroundPort port{};
  TimePoint admitted{};
  TimePoint heard{};           ///< when a packet of it was taken last; at first when it came
  std::uint64_t packets{0};    ///< of plausible form, and taken
  std::uint64_t valid_packets{0};  ///< whole and undamaged
  std::uint64_t octets_received{0};
  std::uint64_t octets_sent{0};
};

/// One client of the link: what it sends, what it has read, and when it had its turns.
struct GroundClient {
  explicit GroundClient(Duration incomplete) noexcept : deframer{incomplete} {}
  ClientId id{0};  ///< 0: free
  std::uint8_t generation{0};
  bool queued{false};  ///< has a turn
  std::uint64_t order{0};
  std::uint64_t read_to{0};
  std::optional<CloseReason> dismissed{};
  std::optional<TimePoint> behind_since{};  ///< of a listener: since then it has taken less than progress_octets
  std::uint64_t behind_from{0};
  /// Who sends little: a packet moves it on by little_period, and never further ahead than one beyond little_burst.
  TimePoint allowance{};
  ClientCounters counters{};
  bool settled{true};
  std::uint64_t settled_at{0};  ///< what came before this octet of it was perhaps said before a stop
  Deframer deframer;
  [[nodiscard]] bool waits() const noexcept { return !deframer.front().empty(); }
  [[nodiscard]] bool listens() const noexcept {
    return id != 0 && !dismissed && counters.port == GroundPort::TelemetryAndTelecommands;
  }
};

/// All clients of the link. Telemetry is kept once, in a ring that every client reads at its own pace; who falls behind
/// by more than the ring is cut, never waited for. Telecommands are taken in turn, one of each client, and stay with
/// their client, which is then not read, while nobody takes them: nothing that was received is lost.
/// Every telecommand brings reports to all listeners. While one of these is behind and catching up, only clients that
/// send little have their turn, so that a flood is as fast as the slowest honest listener reads and delays nobody else;
/// who does not catch up in time is not waited for.
/// When all places are taken, a client that has never sent a valid packet gives way; a pure listener keeps its place by
/// one ping. Some places are never given to the telemetry port: on the telecommand port a newcomer always gets
/// in, there the one that was quiet for longest gives way (docs/adr/0028).
/// Realtime: bounded; memory is taken by the constructor. Thread: one.
class GroundClients {
 public:
  static constexpr std::size_t most_clients = Turns::most;
  struct Limits {
    std::size_t clients{most_clients};
    std::size_t reserve{16};  ///< places for the telecommand port alone; at most an eighth of all
    std::size_t backlog_octets{1 << 20};  ///< telemetry that a client may leave unread
    Duration incomplete{2s};
    std::size_t behind_octets{64 << 10};  ///< telemetry that a listener has not taken: it is behind
    Duration patience{1s};  ///< in which a listener that is behind has to take `progress_octets`
    std::size_t progress_octets{16 << 10};
  };
  struct Admission {
    ClientId client{};
    std::optional<ClientId> evicted{};  ///< its place is gone: close its connection
  };

  explicit GroundClients(const Limits& limits);

  /// False for the moment when all who could give way have packets that wait.
  [[nodiscard]] bool admissible(GroundPort port) const noexcept;
  /// ResourceExhausted: refused.
  [[nodiscard]] Result<Admission> admit(GroundPort port, TimePoint now);
  /// Where the next octets of a client belong; empty while it is not to be read.
  [[nodiscard]] MutableOctets room(ClientId client) noexcept;
  /// So many octets were put there.
  void received(ClientId client, std::size_t octets, TimePoint now) noexcept;
  /// Everything was stopped: what clients have sent, read or not, was perhaps said before that, and so is all that comes of each until it is
  /// settled().
  void all_stopped() noexcept;
  /// The same of one that came in since.
  void all_stopped(ClientId client) noexcept;
  /// Nothing is left of what the client had sent when everything was stopped, but for what stands here already.
  void settled(ClientId client) noexcept;
  [[nodiscard]] bool is_settled(ClientId client) const noexcept;
  /// Offers what waits, one packet of each client in turn, to `traffic`; at most `packets_per_turn`. True when it ended
  /// because nothing waits any more.
  bool hand_over(GroundTraffic& traffic, TimePoint now);
  /// Somebody's packets have not been taken yet.
  [[nodiscard]] bool packets_wait() const noexcept { return turns_.size() != 0; }
  /// Whole packets that nobody has taken yet.
  [[nodiscard]] std::size_t waiting_packets() const noexcept;
  /// Queues a packet for every client of the telemetry port. ResourceExhausted: longer than the backlog.
  Result<> telemetry(Octets packet);
  /// What may be sent to the client next, as far as it is in one piece; empty when it has everything.
  [[nodiscard]] Octets output(ClientId client) const noexcept;
  void sent(ClientId client, std::size_t octets) noexcept;
  /// Finds packets that are overdue; the next time to look.
  std::optional<TimePoint> step(TimePoint now) noexcept;
  /// The client has ended its sending direction.
  void end_input(ClientId client) noexcept;
  /// The client is to go; its packets are handed over before it is condemned.
  void dismiss(ClientId client, CloseReason reason) noexcept;
  /// The connection is to be closed for this reason; empty while it is welcome, or has packets that wait.
  [[nodiscard]] std::optional<CloseReason> condemned(ClientId client) const noexcept;
  /// The connection is closed; its own reason goes before `reason`.
  void remove(ClientId client, CloseReason reason) noexcept;

  [[nodiscard]] const ClientCounters* counters_of(ClientId client) const noexcept;
  [[nodiscard]] const LinkCounters& counters() const noexcept { return counters_; }
  /// Index below `most_clients`, unique among present clients.
  [[nodiscard]] static constexpr std::size_t place_of(ClientId client) noexcept { return client % most_clients; }
  static constexpr int packets_per_turn = 1024;

 private:
  using Client = GroundClient;
  [[nodiscard]] Client* find(ClientId client) noexcept;
  [[nodiscard]] const Client* find(ClientId client) const noexcept;
  [[nodiscard]] Client* free_place(GroundPort port) noexcept;
  [[nodiscard]] bool has_free_place(GroundPort port) const noexcept;
  [[nodiscard]] Client* who_gives_way(GroundPort port, TimePoint now) noexcept;
  [[nodiscard]] bool permanent(const Client& client, GroundPort newcomer) const noexcept;
  void queue(Client& client) noexcept;
  [[nodiscard]] bool somebody_catches_up(TimePoint now) noexcept;

  Limits limits_;
  std::vector<Client> clients_;
  TelemetryRing ring_;
  std::uint64_t next_order_{0};
  std::size_t listeners_{0};
  Turns turns_;  ///< of those whose packets wait
  LinkCounters counters_;
};

}  // namespace hirosco::communication
