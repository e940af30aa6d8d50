// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/ground_connection.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::tools {

Result<GroundConnection> GroundConnection::open(const std::string& address, std::uint16_t port) {
  sockaddr_in peer{};
  peer.sin_family = AF_INET;
  peer.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &peer.sin_addr) != 1)
    return fail(ErrorCode::InvalidArgument, "not an IPv4 address");
  FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  if (!socket) return fail(ErrorCode::SystemFailure, "socket", errno);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&peer), sizeof peer) != 0)
    return fail(ErrorCode::Unavailable, "nobody answers there: does the mission run?", errno);
  // What is said leaves at once and does not wait here for the answer to what was said before.
  const int yes = 1;
  ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return GroundConnection{std::move(socket)};
}

Result<> GroundConnection::send(Octets packet) {
  while (!packet.empty()) {
    const auto sent = ::send(socket_.get(), packet.data(), packet.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return fail(ErrorCode::Unavailable, "the link was closed", errno);
    packet = packet.subspan(static_cast<std::size_t>(sent));
  }
  return ok();
}

Result<std::optional<std::vector<std::byte>>> GroundConnection::receive(Duration limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  for (;;) {
    if (stream_.size() >= pus::primary_header_octets) {
      const std::size_t octets = pus::announced_octets(stream_);
      if (stream_.size() >= octets) {
        const auto behind = stream_.begin() + static_cast<std::ptrdiff_t>(octets);
        std::vector<std::byte> packet{stream_.begin(), behind};
        stream_.erase(stream_.begin(), behind);
        return packet;
      }
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() < 0) return std::nullopt;
    pollfd wanted{socket_.get(), POLLIN, 0};
    if (::poll(&wanted, 1, static_cast<int>(left.count())) <= 0) return std::nullopt;
    std::array<std::byte, 65'536> buffer;
    const auto got = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return fail(ErrorCode::Unavailable, "the link was closed");
    stream_.insert(stream_.end(), buffer.begin(), buffer.begin() + got);
  }
}

}  // namespace hirosco::tools
