// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/tcp_server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <utility>

namespace hirosco::communication {

namespace {

constexpr int accepts_per_step = 16;
/// Times that everybody who has something to say is read in one step, as much as it may leave unread on board.
constexpr int rounds_per_step = 4;
constexpr int listen_backlog = 512;
/// What a client has sent may stand at its own end until what it had sent before is acknowledged, which is at once here, and by others
/// within 40 ms.
constexpr Duration settles_after = 50ms;
/// Of telemetry in the kernel: what is there is late already, so that little of it may be.
constexpr int send_buffer_octets = 64 * 1024;
// The epoll data of a connection is its ClientId, which is never below most_clients; listeners use the numbers below.
constexpr std::uint32_t first_client_mark = GroundClients::most_clients;

bool would_block(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

Result<in_addr> loopback_address(const std::string& text) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1)
    return fail(ErrorCode::InvalidArgument, "not an IPv4 address in numbers");
  if (ntohl(address.s_addr) >> 24 != 127) return fail(ErrorCode::NotPermitted, "the ground link binds loopback only");
  return address;
}

Result<> split(std::string_view text, std::string& host, std::uint16_t& port) {
  if (text.empty()) return ok();
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0)
    return fail(ErrorCode::InvalidArgument, "an address of the ground link is HOST:PORT");
  const auto [end, problem] = std::from_chars(text.data() + colon + 1, text.data() + text.size(), port);
  if (problem != std::errc{} || end != text.data() + text.size())
    return fail(ErrorCode::InvalidArgument, "port of the ground link");
  host = text.substr(0, colon);
  return ok();
}

}  // namespace

Result<TcpServer::Options> TcpServer::at(std::string_view telemetry, std::string_view telecommand) {
  Options options;
  HIROSCO_TRY(split(telemetry, options.address, options.telemetry_port));
  HIROSCO_TRY(split(telecommand, options.telecommand_address, options.telecommand_port));
  return options;
}

TcpServer::TcpServer(const Options& options, GroundTraffic& traffic) : traffic_{traffic}, clients_{options.limits} {}
TcpServer::~TcpServer() = default;

Result<std::unique_ptr<TcpServer>> TcpServer::open(const Options& options, GroundTraffic& traffic) {
  std::unique_ptr<TcpServer> server{new TcpServer{options, traffic}};
  server->epoll_.reset(::epoll_create1(EPOLL_CLOEXEC));
  server->spare_.reset(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!server->epoll_) return fail(ErrorCode::SystemFailure, "epoll", errno);
  HIROSCO_TRY(server->listen_on(GroundPort::TelemetryAndTelecommands, options));
  HIROSCO_TRY(server->listen_on(GroundPort::TelecommandsOnly, options));
  return server;
}

Result<> TcpServer::listen_on(GroundPort port, const Options& options) {
  const bool telemetry = port == GroundPort::TelemetryAndTelecommands;
  const bool same = telemetry || options.telecommand_address.empty();
  HIROSCO_TRY_LET(const in_addr host, loopback_address(same ? options.address : options.telecommand_address));
  FileDescriptor listener{::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  if (!listener) return fail(ErrorCode::SystemFailure, "socket of the ground link", errno);
  const int yes = 1;
  ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr = host;
  address.sin_port = htons(telemetry ? options.telemetry_port : options.telecommand_port);
  if (::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener.get(), listen_backlog) != 0)
    return errno == EADDRINUSE
               ? fail(ErrorCode::Unavailable, "a port of the ground link is taken, by another flight perhaps", errno)
               : fail(ErrorCode::SystemFailure, "port of the ground link", errno);
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u32 = std::to_underlying(port);
  if (::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, listener.get(), &event) != 0)
    return fail(ErrorCode::SystemFailure, "epoll", errno);
  listeners_[std::to_underlying(port)] = std::move(listener);
  return ok();
}

std::uint16_t TcpServer::port(GroundPort port) const noexcept {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  const int listener = listeners_[std::to_underlying(port)].get();
  if (::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  return ntohs(address.sin_port);
}

void TcpServer::all_stopped() noexcept {
  clients_.all_stopped();
  stop_heard_ = true;
  perhaps_before_ = {true, true};
}

std::optional<TimePoint> TcpServer::step(TimePoint now) {
  if (std::exchange(stop_heard_, false)) settles_from_ = now + settles_after;
  // Those who are in are served before others come in: a flood of newcomers cannot evict who has something to say.
  static_cast<void>(clients_.hand_over(traffic_, now));
  knocking_ = {};
  for (int round = 0; round < rounds_per_step; ++round)
    if (!serve_ready(now) || !clients_.hand_over(traffic_, now)) break;
  for (const GroundPort port : {GroundPort::TelemetryAndTelecommands, GroundPort::TelecommandsOnly})
    if (knocking_[std::to_underlying(port)] || perhaps_before_[std::to_underlying(port)]) accept_clients(port, now);
  static_cast<void>(clients_.hand_over(traffic_, now));
  if (now >= settles_from_) settle();
  const auto next = clients_.step(now);
  for (Connection& connection : connections_)
    if (connection.client != 0) tend(connection);
  return next;
}

std::size_t TcpServer::finish(TimePoint now) {
  listeners_ = {};
  for (Connection& connection : connections_) {
    if (connection.client == 0 || !connection.socket || connection.deaf) continue;
    clients_.end_input(connection.client);
    connection.deaf = true;
    watch(connection, EPOLL_CTL_MOD);
  }
  step(now);
  return clients_.waiting_packets();
}

/// What is due for a connection after the others had their turn.
void TcpServer::tend(Connection& connection) {
  if (const auto reason = clients_.condemned(connection.client)) {
    clients_.remove(connection.client, *reason);
    connection = Connection{};
    return;
  }
  if (!connection.socket) return;  // its packets wait, and then it goes
  write_to(connection);
  if (const bool held = clients_.room(connection.client).empty(); connection.socket && held != connection.held) {
    connection.held = held;
    watch(connection, EPOLL_CTL_MOD);
  }
}

/// Twice, as what becomes free at this end lets more come from the other.
void TcpServer::settle() noexcept {
  for (Connection& connection : connections_) {
    // Who has ended its direction says nothing new.
    const bool speaks = connection.client != 0 && connection.socket && !connection.deaf;
    if (!speaks || clients_.is_settled(connection.client)) continue;
    std::byte next{};
    const bool empty =
        ::recv(connection.socket.get(), &next, sizeof next, MSG_PEEK | MSG_DONTWAIT) < 0 && would_block(errno);
    if (empty && connection.found_empty) clients_.settled(connection.client);
    connection.found_empty = empty;
  }
}

/// Whether anything was read.
bool TcpServer::serve_ready(TimePoint now) {
  std::array<epoll_event, GroundClients::most_clients + 2> events{};
  const int count = ::epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()), 0);
  bool something = false;
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events[static_cast<std::size_t>(i)];
    if (event.data.u32 < first_client_mark) {
      knocking_[event.data.u32] = true;
      continue;
    }
    Connection& connection = connections_[GroundClients::place_of(static_cast<ClientId>(event.data.u32))];
    if (connection.client != event.data.u32) continue;
    if ((event.events & EPOLLOUT) != 0) {
      connection.full = false;
      watch(connection, EPOLL_CTL_MOD);
    }
    // Whoever has gone may have left octets: the end is what reading finds behind them.
    if ((event.events & (EPOLLIN | EPOLLERR | EPOLLHUP)) != 0 && connection.socket)
      something = read_from(connection, now) || something;
  }
  return something;
}

void TcpServer::accept_clients(GroundPort port, TimePoint now) {
  const int listener = listeners_[std::to_underlying(port)].get();
  for (int i = 0; i < accepts_per_step; ++i) {
    // Whoever cannot come in now because of packets that wait is better off in the kernel's queue than refused.
    if (!clients_.admissible(port)) return;
    FileDescriptor socket{::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
    if (!socket && (errno == EMFILE || errno == ENFILE))
      return knocking_[std::to_underlying(port)] ? make_room_by_refusing(listener) : void();
    // All who had come before the stop are in.
    if (!socket && errno == EAGAIN && now >= settles_from_) perhaps_before_[std::to_underlying(port)] = false;
    if (!socket && errno != ECONNABORTED && errno != EINTR) return;
    if (socket) welcome(std::move(socket), port, now);
  }
}

void TcpServer::make_room_by_refusing(int listener) {
  spare_.reset();
  FileDescriptor{::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC)}.reset();
  spare_.reset(::open("/dev/null", O_RDONLY | O_CLOEXEC));
}

void TcpServer::welcome(FileDescriptor socket, GroundPort port, TimePoint now) {
  const auto admission = clients_.admit(port, now);
  if (!admission) return;
  Connection& connection = connections_[GroundClients::place_of(admission->client)];
  // An evicted client had the same place: its socket closes here.
  connection = Connection{.client = admission->client, .socket = std::move(socket)};
  const int yes = 1;
  ::setsockopt(connection.socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  ::setsockopt(connection.socket.get(), SOL_SOCKET, SO_SNDBUF, &send_buffer_octets, sizeof send_buffer_octets);
  if (perhaps_before_[std::to_underlying(port)]) clients_.all_stopped(connection.client);
  watch(connection, EPOLL_CTL_ADD);
  if (connection.socket) static_cast<void>(read_from(connection, now));
}

bool TcpServer::read_from(Connection& connection, TimePoint now) {
  const MutableOctets room = clients_.room(connection.client);
  if (room.empty()) {
    // Nothing more comes from it, but its end shows.
    if (connection.deaf) return end_of_stream(connection), false;
    return false;
  }
  const ssize_t count = ::recv(connection.socket.get(), room.data(), room.size(), 0);
  if (count == 0) return end_of_stream(connection), false;
  if (count < 0 && would_block(errno)) return false;
  if (count < 0)
    return dismiss(connection, errno == ECONNRESET ? CloseReason::PeerClosed : CloseReason::SocketError), false;
  connection.found_empty = false;
  const int yes = 1;
  ::setsockopt(connection.socket.get(), IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
  clients_.received(connection.client, static_cast<std::size_t>(count), now);
  return true;
}

void TcpServer::end_of_stream(Connection& connection) {
  const ClientCounters* counters = clients_.counters_of(connection.client);
  // A listener may end its own direction and still want telemetry; when it is gone altogether, writing tells.
  if (counters == nullptr || counters->port == GroundPort::TelecommandsOnly || connection.deaf)
    return dismiss(connection, CloseReason::PeerClosed);
  clients_.end_input(connection.client);
  connection.deaf = true;
  watch(connection, EPOLL_CTL_MOD);
}

void TcpServer::write_to(Connection& connection) {
  while (!connection.full) {
    const Octets output = clients_.output(connection.client);
    if (output.empty()) return;
    const ssize_t count = ::send(connection.socket.get(), output.data(), output.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      clients_.sent(connection.client, static_cast<std::size_t>(count));
    } else if (would_block(errno)) {
      connection.full = true;
      watch(connection, EPOLL_CTL_MOD);
    } else {
      const bool gone = errno == EPIPE || errno == ECONNRESET;
      return dismiss(connection, gone ? CloseReason::PeerClosed : CloseReason::SocketError);
    }
  }
}

void TcpServer::watch(Connection& connection, int operation) {
  if (!connection.socket) return;
  epoll_event event{};
  event.events = (connection.deaf || connection.held ? 0U : static_cast<std::uint32_t>(EPOLLIN)) |
                 (connection.full ? static_cast<std::uint32_t>(EPOLLOUT) : 0U);
  event.data.u32 = connection.client;
  if (::epoll_ctl(epoll_.get(), operation, connection.socket.get(), &event) != 0)
    dismiss(connection, CloseReason::SocketError);
}

/// The connection ends now; its client stays until what it sent has been taken.
void TcpServer::dismiss(Connection& connection, CloseReason reason) {
  clients_.dismiss(connection.client, reason);
  connection.socket.reset();
}

}  // namespace hirosco::communication
