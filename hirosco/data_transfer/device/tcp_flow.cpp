// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/tcp_flow.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "hirosco/data_transfer/device/device_socket.hpp"
#include "hirosco/data_transfer/device/framed_stream.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

/// Segments that the other side has not acknowledged: what lies under way behind them would be old when it comes.
constexpr std::uint32_t most_unacknowledged = 64;
constexpr unsigned silent_connection_ms = 500;
/// A connection that is not there by then is begun anew.
constexpr Duration connecting_patience = std::chrono::seconds{1};
constexpr int most_accepted = 4;

/// Frames go out as they come, and a connection that carries nothing ends.
void prepare(int socket) noexcept {
  const int at_once = 1;
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &silent_connection_ms, sizeof silent_connection_ms);
}

[[nodiscard]] tcp_info about(int socket) noexcept {
  tcp_info info{};
  socklen_t octets = sizeof info;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &octets) != 0) info.tcpi_state = TCP_CLOSE;
  return info;
}

/// The one connection of a flow, as both sides have it.
class Connection {
 public:
  explicit Connection(Framing framing) noexcept : stream_{FramedStream::Carrier::Socket, framing} {}
  [[nodiscard]] bool there() const noexcept { return socket_.valid(); }
  [[nodiscard]] int socket() const noexcept { return socket_.get(); }
  void take(FileDescriptor socket) noexcept {
    prepare(socket.get());
    socket_ = std::move(socket);
    stream_.restart();
    was_there_ = true;
  }
  void leave() noexcept { socket_.reset(); }
  [[nodiscard]] bool was_there() const noexcept { return was_there_; }

  [[nodiscard]] Result<> send(Octets frame) noexcept {
    const tcp_info info = about(socket_.get());
    if (info.tcpi_state != TCP_ESTABLISHED) {
      leave();
      return fail(ErrorCode::Unavailable, "peer has hung up", EPIPE);
    }
    if (info.tcpi_unacked > most_unacknowledged) return fail(ErrorCode::Unavailable, "peer does not read");
    const auto sent = stream_.send(socket_.get(), frame);
    if (is_gone(sent)) leave();
    return sent;
  }
  [[nodiscard]] Result<Received> receive(MutableOctets buffer) noexcept {
    auto received = stream_.receive(socket_.get(), buffer);
    if (is_gone(received)) leave();
    return received;
  }

 private:
  template <class T>
  [[nodiscard]] static bool is_gone(const Result<T>& result) noexcept {
    return !result && result.error().code == ErrorCode::Unavailable && result.error().value != 0;
  }

  FileDescriptor socket_;
  FramedStream stream_;
  bool was_there_{false};
};

/// Nothing on a flow without a connection: a peer that never came has not gone.
[[nodiscard]] Result<Received> nothing_from(const Connection& connection) noexcept {
  if (!connection.was_there()) return Received{};
  return fail(ErrorCode::Unavailable, "peer has hung up");
}

class TcpClient final : public DataFlow {
 public:
  TcpClient(DeviceRoute route, Framing framing) : route_{route}, connection_{framing} {
    if (route.network != nullptr) route_.network = &network_.emplace(*route.network);
    static_cast<void>(ready());
  }
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

 private:
  /// Whether there is a connection; begins one, or looks after one that is being made.
  [[nodiscard]] bool ready() noexcept {
    if (connection_.there()) return true;
    const TimePoint now = clock_.now();
    if (!begun_) {
      if (now < next_try_) return false;
      next_try_ = now + reconnect_pause;
      auto socket = make_device_socket(SOCK_STREAM, route_, route_.own);
      if (!socket) return false;
      prepare(socket->get());
      if (::connect(socket->get(), route_.device.get(), route_.device.octets) != 0 && errno != EINPROGRESS)
        return false;
      begun_ = std::move(*socket);
      begun_at_ = now;
    }
    const auto state = about(begun_.get()).tcpi_state;
    if (state == TCP_ESTABLISHED && !is_with_itself()) {
      connection_.take(std::move(begun_));
      return true;
    }
    if (state != TCP_SYN_SENT || now - begun_at_ > connecting_patience) begun_.reset();
    return false;
  }

  /// The system may choose the device's port for this end, and connect it with itself.
  [[nodiscard]] bool is_with_itself() const noexcept {
    const auto own = own_internet_address(begun_.get()), there = internet_address(route_.device);
    return !own || (there && own->port == there->port && route_.network == nullptr);
  }

  [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
    if (frame.size() > max_frame_octets)
      return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
    // A device that came back in between has the frame by a new connection.
    for (int tries = 0; tries < 2 && ready(); ++tries) {
      const auto sent = connection_.send(frame);
      if (sent || connection_.there()) return sent;
    }
    return fail(ErrorCode::Unavailable, "nobody listens");
  }
  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    return ready() ? connection_.receive(buffer) : nothing_from(connection_);
  }
  [[nodiscard]] bool do_wait(Duration timeout) noexcept override {
    const TimePoint end = clock_.now() + timeout;
    do {
      const Duration left = std::max(end - clock_.now(), Duration::zero());
      if (ready()) return wait_readable(connection_.socket(), left);
      sleep_until(clock_.now() + std::min(left, reconnect_pause));
    } while (clock_.now() < end);
    return false;
  }

  SystemClock clock_;
  DeviceRoute route_;
  std::optional<DeviceNetwork> network_;  ///< the route's, which the opening only lent
  Connection connection_;
  FileDescriptor begun_;  ///< a connection that is being made
  TimePoint begun_at_{};
  TimePoint next_try_{};
};

class TcpListener final : public DataFlow {
 public:
  TcpListener(FileDescriptor listener, Framing framing) : listener_{std::move(listener)}, connection_{framing} {}

 private:
  /// Who connected last is the one: a subsystem that died without a word may still have a connection here.
  void accept_newest() noexcept {
    for (int accepted = 0; accepted < most_accepted; ++accepted) {
      FileDescriptor next{::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
      if (!next) return;
      connection_.take(std::move(next));
    }
  }
  [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
    if (frame.size() > max_frame_octets)
      return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
    accept_newest();
    return connection_.there() ? connection_.send(frame) : fail(ErrorCode::Unavailable, "nobody listens");
  }
  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    accept_newest();
    return connection_.there() ? connection_.receive(buffer) : nothing_from(connection_);
  }
  [[nodiscard]] bool do_wait(Duration timeout) noexcept override {
    const TimePoint end = clock_.now() + timeout;
    do {
      accept_newest();
      std::array<pollfd, 2> looked{pollfd{listener_.get(), POLLIN, 0}, pollfd{connection_.socket(), POLLIN, 0}};
      const Duration left = std::max(end - clock_.now(), Duration::zero());
      const timespec rest{left / std::chrono::seconds{1}, (left % std::chrono::seconds{1}).count()};
      static_cast<void>(::ppoll(looked.data(), looked.size(), &rest, nullptr));
      if (looked[1].revents != 0) return true;
    } while (clock_.now() < end);
    return false;
  }

  SystemClock clock_;
  FileDescriptor listener_;
  Connection connection_;
};

}  // namespace

Result<std::unique_ptr<DataFlow>> open_tcp_flow(const FlowOpening& opening) {
  HIROSCO_TRY_LET(const DeviceRoute route, find_route(opening));
  if (opening.side == FlowSide::Subsystem) return std::make_unique<TcpClient>(route, opening.framing);
  HIROSCO_TRY_LET(FileDescriptor socket, make_device_socket(SOCK_STREAM, route, route.device));
  if (::listen(socket.get(), most_accepted) != 0)
    return errno == EADDRINUSE ? fail(ErrorCode::AlreadyExists, "this side of the flow is open", errno)
                               : fail(ErrorCode::SystemFailure, "listen", errno);
  return std::make_unique<TcpListener>(std::move(socket), opening.framing);
}

void let_in_tcp(const std::string& address, Sandbox& sandbox) {
  const auto device = read_device_address(address);
  if (!device) return;
  SandboxSockets& sockets = sandbox.sockets;
  if (std::ranges::find(sockets.ports, device->port) == sockets.ports.end()) sockets.ports.push_back(device->port);
  if (device->loopback()) return;
  // By a datagram it is found out from where the system would speak to a device in a network, and its own end is bound to an address of that.
  sockets.datagrams = true;
  sockets.own_port = true;
}

bool is_reached_by_tcp(const std::string& address, const Sandbox& sandbox) {
  const auto held = read_device_address(address);
  const SandboxSockets& sockets = sandbox.sockets;
  return held && held->loopback() &&
         (sockets.streams || std::ranges::find(sockets.ports, held->port) != sockets.ports.end());
}

}  // namespace hirosco
