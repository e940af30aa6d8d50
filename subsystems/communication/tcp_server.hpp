// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "subsystems/communication/ground_clients.hpp"

namespace hirosco::communication {

/// The sockets of the ground link: two listening ports on a loopback address, nothing blocks, no thread of its own.
/// Its owner waits for `descriptor()` to become readable or for the time that `step` named, then calls `step`.
/// Anything but a loopback address is refused until connections are authenticated; that check will stand between
/// acceptance and the deframer, in `accept_clients`.
/// Thread: one.
class TcpServer {
 public:
  struct Options {
    std::string address{"127.0.0.1"};  ///< an IPv4 address within 127.0.0.0/8
    std::string telecommand_address{};  ///< of the port for telecommands only; empty = the same
    std::uint16_t telemetry_port{10'015};  ///< 0: any free one
    std::uint16_t telecommand_port{10'025};
    GroundClients::Limits limits{};
  };

  /// Where to listen by addresses HOST:PORT; an empty one leaves its defaults. InvalidArgument: it is none.
  [[nodiscard]] static Result<Options> at(std::string_view telemetry, std::string_view telecommand);
  /// NotPermitted: not a loopback address. SystemFailure: errno (port taken). `traffic` outlives the server.
  [[nodiscard]] static Result<std::unique_ptr<TcpServer>> open(const Options& options, GroundTraffic& traffic);
  ~TcpServer();
  TcpServer(const TcpServer&) = delete;
  TcpServer& operator=(const TcpServer&) = delete;

  /// GroundTransport::all_stopped().
  void all_stopped() noexcept;  // the step that follows says when
  /// Accepts, reads, hands over, writes and closes what is due, a bounded amount for each client; never blocks. The next
  /// time at which it has to be called even when `descriptor()` stays silent: that of its own limits; while packets wait
  /// for somebody who takes them, its owner knows best when that may be.
  std::optional<TimePoint> step(TimePoint now);
  /// As `step`, but nobody comes in and nothing more is read: what has been received is handed over, and listeners get
  /// the reports on it. How many whole packets still wait; `step` is not to be called any more.
  [[nodiscard]] std::size_t finish(TimePoint now);
  /// Queues a packet for all telemetry clients; it leaves with the next `step`. ResourceExhausted: longer than
  /// the backlog.
  Result<> telemetry(Octets packet) { return clients_.telemetry(packet); }

  /// Readable when there is something to do; to be polled, not read.
  [[nodiscard]] int descriptor() const noexcept { return epoll_.get(); }
  [[nodiscard]] std::uint16_t port(GroundPort port) const noexcept;
  [[nodiscard]] const LinkCounters& counters() const noexcept { return clients_.counters(); }
  [[nodiscard]] const GroundClients& clients() const noexcept { return clients_; }

 private:
  struct Connection {
    ClientId client{0};
    FileDescriptor socket;
    bool full{false};  ///< the kernel takes no more for now
    bool deaf{false};  ///< the client has ended its sending direction
    bool held{false};  ///< not read while its packets wait
    bool found_empty{false};  ///< by the last settle(), and nothing has come since
  };

  TcpServer(const Options& options, GroundTraffic& traffic);
  Result<> listen_on(GroundPort port, const Options& options);
  [[nodiscard]] bool serve_ready(TimePoint now);
  void accept_clients(GroundPort port, TimePoint now);
  void make_room_by_refusing(int listener);
  void welcome(FileDescriptor socket, GroundPort port, TimePoint now);
  [[nodiscard]] bool read_from(Connection& connection, TimePoint now);
  void end_of_stream(Connection& connection);
  void write_to(Connection& connection);
  void watch(Connection& connection, int operation);
  void tend(Connection& connection);
  void settle() noexcept;
  void dismiss(Connection& connection, CloseReason reason);

  GroundTraffic& traffic_;
  GroundClients clients_;
  FileDescriptor epoll_;
  FileDescriptor spare_;  ///< given up for a moment to refuse a client when descriptors run out
  std::array<FileDescriptor, 2> listeners_;
  std::array<bool, 2> knocking_{};  ///< somebody wants in, by GroundPort
  bool stop_heard_{false};
  TimePoint settles_from_{};  ///< before it an empty socket says nothing
  std::array<bool, 2> perhaps_before_{};  ///< whoever is let in there now may have come before the newest stop
  std::array<Connection, GroundClients::most_clients> connections_;
};

}  // namespace hirosco::communication
