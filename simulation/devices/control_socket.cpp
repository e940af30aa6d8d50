// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/control_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hirosco::simulation {
namespace {

Result<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    return fail(ErrorCode::OutOfRange, "length of control path", static_cast<std::int64_t>(path.size()));
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

const sockaddr* as_any(const sockaddr_un& address) noexcept { return reinterpret_cast<const sockaddr*>(&address); }

/// A socket file whose server is gone refuses connections; any other file is left alone.
void remove_abandoned(const std::string& path, const sockaddr_un& address) {
  struct stat about{};
  if (::lstat(path.c_str(), &about) != 0 || !S_ISSOCK(about.st_mode)) return;
  const FileDescriptor probe{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  if (::connect(probe.get(), as_any(address), sizeof address) != 0 && errno == ECONNREFUSED)
    (void)::unlink(path.c_str());
}

}  // namespace

ControlSocket::~ControlSocket() {
  if (listener_) (void)::unlink(path_.c_str());
}

Result<> ControlSocket::listen(const std::string& path) {
  HIROSCO_TRY_LET(const sockaddr_un address, address_of(path));
  remove_abandoned(path, address);
  FileDescriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  if (!socket) return fail(ErrorCode::SystemFailure, "control socket", errno);
  if (::bind(socket.get(), as_any(address), sizeof address) != 0) return fail(ErrorCode::SystemFailure, "bind", errno);
  if (::listen(socket.get(), static_cast<int>(most_clients)) != 0)
    return fail(ErrorCode::SystemFailure, "listen", errno);
  listener_ = std::move(socket);
  path_ = path;
  return ok();
}

void ControlSocket::serve(const std::function<std::string(std::string_view)>& answer) {
  if (!listener_) return;
  accept_clients();
  for (Client& client : clients_)
    if (client.socket) serve_client(client, answer);
}

void ControlSocket::accept_clients() {
  for (Client& client : clients_) {
    if (client.socket) continue;
    client.socket.reset(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    client.pending.clear();
    if (!client.socket) return;
  }
}

void ControlSocket::serve_client(Client& client, const std::function<std::string(std::string_view)>& answer) {
  std::array<char, longest_line + 1> buffer;
  const ssize_t got = ::recv(client.socket.get(), buffer.data(), buffer.size(), 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) return client.socket.reset();
  client.pending.append(buffer.data(), static_cast<std::size_t>(got));
  for (auto end = client.pending.find('\n'); end != std::string::npos; end = client.pending.find('\n')) {
    const std::string reply = answer(std::string_view{client.pending}.substr(0, end)) + '\n';
    client.pending.erase(0, end + 1);
    // A client that does not read its answers has no further use for us.
    const ssize_t sent = ::send(client.socket.get(), reply.data(), reply.size(), MSG_NOSIGNAL);
    if (sent != static_cast<ssize_t>(reply.size())) return client.socket.reset();
  }
  if (client.pending.size() > longest_line) client.socket.reset();
}

}  // namespace hirosco::simulation
