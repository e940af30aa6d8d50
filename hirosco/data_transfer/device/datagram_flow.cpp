// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/datagram_flow.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "hirosco/data_transfer/device/device_socket.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

constexpr int most_at_once = 16;

using Address = SocketAddress;

bool is_gone(int number) noexcept {
  return number == ECONNREFUSED || number == ENOENT || number == ECONNRESET || number == ENOTCONN || number == EPIPE;
}

class DatagramFlow final : public DataFlow {
 public:
  /// `peer` empty: learnt from what arrives. `own_path` is removed at the end.
  DatagramFlow(FileDescriptor socket, Address peer, bool learns, std::string own_path)
      : socket_{std::move(socket)}, peer_{peer}, learns_{learns}, own_path_{std::move(own_path)} {}
  ~DatagramFlow() override {
    if (!own_path_.empty()) (void)::unlink(own_path_.c_str());
  }
  DatagramFlow(const DatagramFlow&) = delete;
  DatagramFlow& operator=(const DatagramFlow&) = delete;

 private:
  [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
    if (frame.size() > max_frame_octets)
      return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
    if (learns_ && peer_.octets == 0) return fail(ErrorCode::Unavailable, "nobody listens");
    const sockaddr* const to = peer_.octets == 0 ? nullptr : peer_.get();
    if (::sendto(socket_.get(), frame.data(), frame.size(), MSG_DONTWAIT | MSG_NOSIGNAL, to, peer_.octets) >= 0)
      return ok();
    if (errno == EAGAIN || errno == ENOBUFS || is_gone(errno))
      return fail(ErrorCode::Unavailable, is_gone(errno) ? "nobody listens" : "peer does not read", errno);
    return fail(ErrorCode::SystemFailure, "send frame", errno);
  }

  /// Older frames are let go: whoever paused for a while would else control on what was, for ever.
  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    Received newest;
    for (int frames = 0; frames < most_at_once; ++frames) {
      const auto next = receive_one(buffer);
      const bool overwritten = !next && next.error().code == ErrorCode::Malformed;
      if (!next && (newest.flow == Flow::None || overwritten)) return next;
      if (!next || next->flow == Flow::None) break;
      newest = *next;
    }
    return newest;
  }

  [[nodiscard]] Result<Received> receive_one(MutableOctets buffer) noexcept {
    Address from;
    from.octets = sizeof from.storage;
    const ssize_t octets = ::recvfrom(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT | MSG_TRUNC,
                                      reinterpret_cast<sockaddr*>(&from.storage), &from.octets);
    if (octets < 0) {
      if (errno == EAGAIN || errno == EINTR) return Received{};
      return is_gone(errno) ? fail(ErrorCode::Unavailable, "peer has hung up", errno)
                            : fail(ErrorCode::SystemFailure, "receive frame", errno);
    }
    if (learns_) peer_ = from;
    if (static_cast<std::size_t>(octets) > buffer.size())
      return fail(ErrorCode::Malformed, "frame is longer than expected", octets);
    return Received{Flow::New, static_cast<std::size_t>(octets)};
  }

  [[nodiscard]] bool do_wait(Duration timeout) noexcept override { return wait_readable(socket_.get(), timeout); }

  FileDescriptor socket_;
  Address peer_;
  bool learns_;
  std::string own_path_;
};

Address unix_address(const std::string& path) noexcept {
  sockaddr_un local{};
  local.sun_family = AF_UNIX;
  std::memcpy(local.sun_path, path.c_str(), path.size() + 1);
  Address address;
  std::memcpy(&address.storage, &local, sizeof local);
  address.octets = sizeof local;
  return address;
}

Result<FileDescriptor> make_unix_socket() noexcept {
  FileDescriptor socket{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!socket) return fail(ErrorCode::SystemFailure, "make socket", errno);
  return socket;
}

Result<> bind_to(const FileDescriptor& socket, const Address& address) noexcept {
  if (::bind(socket.get(), address.get(), address.octets) == 0) return ok();
  return errno == EADDRINUSE ? fail(ErrorCode::AlreadyExists, "this side of the flow is open", errno)
                             : fail(ErrorCode::SystemFailure, "bind socket", errno);
}

/// Removes what a dead process left at a path, never what is alive or is no socket.
void remove_stale(const std::string& path, const Address& address) noexcept {
  struct stat status{};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode)) return;
  const FileDescriptor probe{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (probe && ::connect(probe.get(), address.get(), address.octets) != 0 && errno == ECONNREFUSED)
    (void)::unlink(path.c_str());
}

}  // namespace

Result<std::unique_ptr<DataFlow>> open_udp_flow(const FlowOpening& opening) {
  HIROSCO_TRY_LET(const DeviceRoute route, find_route(opening));
  const bool device = opening.side == FlowSide::Device;
  HIROSCO_TRY_LET(FileDescriptor socket, make_device_socket(SOCK_DGRAM, route, device ? route.device : route.own));
  // Connected: only then does the system tell that nobody listens, and drop what others send.
  if (!device && ::connect(socket.get(), route.device.get(), route.device.octets) != 0)
    return fail(ErrorCode::SystemFailure, "connect socket", errno);
  return std::make_unique<DatagramFlow>(std::move(socket), Address{}, device, std::string{});
}

Result<std::unique_ptr<DataFlow>> open_unix_flow(const std::string& address, FlowSide side) {
  if (address.empty() || address.size() > 90 || address.find('\0') != std::string::npos)
    return fail(ErrorCode::InvalidArgument, "path of a socket");
  const std::string device = socket_at(address), subsystem = device + ".subsystem";
  const std::string& own_path = side == FlowSide::Device ? device : subsystem;
  const Address own = unix_address(own_path);
  HIROSCO_TRY_LET(FileDescriptor socket, make_unix_socket());
  remove_stale(own_path, own);
  {
    const OpenInPrivate opening{own_path};
    HIROSCO_TRY(bind_to(socket, own));
  }
  return std::make_unique<DatagramFlow>(std::move(socket), unix_address(side == FlowSide::Device ? subsystem : device),
                                        false, own_path);
}

void let_in_udp(const std::string&, Sandbox& sandbox) { sandbox.sockets.datagrams = true; }

bool is_reached_by_udp(const std::string& address, const Sandbox& sandbox) {
  const auto held = read_device_address(address);
  return held && held->loopback() && sandbox.sockets.datagrams;
}

void let_in_unix(const std::string& address, Sandbox& sandbox) {
  std::error_code nowhere;
  const auto place = std::filesystem::absolute(address, nowhere).parent_path();
  if (nowhere) return;
  let_write(place.string(), sandbox);
  sandbox.sockets.local = true;
}

bool is_reached_by_unix(const std::string&, const Sandbox& sandbox) { return sandbox.sockets.local; }

std::string own_unix_folder(const std::string& address) {
  std::error_code nowhere;
  const auto place = std::filesystem::absolute(address, nowhere);
  return nowhere ? std::string{} : place.string();
}

Result<> make_own_unix_folder(const std::string& address, const OwnGroup& own) {
  return make_private_folder(own_unix_folder(address), own.group, own.of_flight);
}

void forget_own_unix(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code failed;
  for (const char* const end : {"/socket", "/socket.subsystem"})
    if (fs::is_socket(fs::symlink_status(folder + end, failed))) fs::remove(folder + end, failed);
}

void let_in_own_unix(const std::string& address, Sandbox& sandbox) {
  std::string folder = own_unix_folder(address);
  if (folder.empty()) return;
  let_write(std::move(folder), sandbox);
  sandbox.sockets.local = true;
}

}  // namespace hirosco
