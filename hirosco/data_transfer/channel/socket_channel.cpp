// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/socket_channel.hpp"

#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco {
namespace {

/// Room for more descriptors than a message may carry, so that a surplus is seen; the kernel closes what does not fit.
constexpr std::size_t noticed_descriptors = 4;

Error send_error(int number) noexcept {
  switch (number) {
    case EAGAIN:
    case ENOBUFS:
    case ETOOMANYREFS: return {ErrorCode::ResourceExhausted, "peer does not read", number};
    case EPIPE:
    case ECONNRESET:
    case ENOTCONN: return {ErrorCode::Unavailable, "peer of control channel is gone", number};
    default: return {ErrorCode::SystemFailure, "send on control channel", number};
  }
}

/// A message as the system call wants it: it stays where it is until that has returned.
class Datagram {
 public:
  [[nodiscard]] Result<> fill(const Message& message, msghdr& header) noexcept {
    if (message.packet.size() > max_packet_octets)
      return fail(ErrorCode::InvalidArgument, "octets of packet", static_cast<std::int64_t>(message.packet.size()));
    OctetWriter writer{envelope_};
    envelope::write(writer, message);
    parts_ = {iovec{envelope_.data(), envelope_.size()},
              iovec{const_cast<std::byte*>(message.packet.data()), message.packet.size()}};
    header = {};
    header.msg_iov = parts_.data();
    header.msg_iovlen = parts_.size();
    if (!message.memory) return ok();
    const int descriptor = SealedMemory::descriptor(message.memory);
    if (descriptor < 0) return fail(ErrorCode::InvalidArgument, "memory handle cannot leave this process");
    attach(header, descriptor);
    return ok();
  }

 private:
  void attach(msghdr& header, int descriptor) noexcept {
    header.msg_control = control_.data();
    header.msg_controllen = control_.size();
    cmsghdr* const control = CMSG_FIRSTHDR(&header);
    control->cmsg_level = SOL_SOCKET;
    control->cmsg_type = SCM_RIGHTS;
    control->cmsg_len = CMSG_LEN(sizeof descriptor);
    std::memcpy(CMSG_DATA(control), &descriptor, sizeof descriptor);
  }

  std::array<std::byte, envelope::octets> envelope_;
  std::array<iovec, 2> parts_;
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(int))> control_;
};

struct Arrived {
  FileDescriptor first;
  std::size_t count{0};
};

/// Takes the descriptors that came; all but the first are closed.
Arrived take_descriptors(msghdr& header) noexcept {
  Arrived arrived;
  for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr; control = CMSG_NXTHDR(&header, control)) {
    if (control->cmsg_level != SOL_SOCKET || control->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (control->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(control) + i * sizeof number, sizeof number);
      FileDescriptor descriptor{number};
      if (arrived.count++ == 0) arrived.first = std::move(descriptor);
    }
  }
  return arrived;
}

/// Octets that may wait behind a socket, those that the system takes beside each message among them.
[[nodiscard]] int room_behind(int socket) noexcept {
  int octets = 0;
  socklen_t length = sizeof octets;
  return ::getsockopt(socket, SOL_SOCKET, SO_SNDBUF, &octets, &length) == 0 ? octets : 0;
}

/// The system doubles what it is asked for, for what it takes beside each message, and grants less without a word.
[[nodiscard]] Result<> give_room(int socket, std::uint32_t kb) noexcept {
  constexpr int octets_of_kb = 1024;
  const int wanted = static_cast<int>(kb) * octets_of_kb, asked = wanted / 2;
  if (::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &asked, sizeof asked) != 0)
    return fail(ErrorCode::SystemFailure, "size of a control channel", errno);
  if (const int granted = room_behind(socket); granted < wanted)
    return fail(ErrorCode::ResourceExhausted, "octets of a control channel: net.core.wmem_max grants fewer", granted);
  return ok();
}

/// An empty datagram and the end look alike to recvmsg.
bool hung_up(int socket) noexcept {
  pollfd entry{socket, POLLRDHUP, 0};
  return ::poll(&entry, 1, 0) > 0 && (entry.revents & (POLLRDHUP | POLLHUP | POLLERR | POLLNVAL)) != 0;
}

}  // namespace

Result<std::pair<FileDescriptor, FileDescriptor>> SocketChannel::make_pair(std::optional<std::uint32_t> kb) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
    return fail(ErrorCode::SystemFailure, "make control channel", errno);
  std::pair made{FileDescriptor{ends[0]}, FileDescriptor{ends[1]}};
  // What waits is charged to whoever has sent it: the size of each end is that of the way out of it.
  for (const int end : ends)
    if (kb) HIROSCO_TRY(give_room(end, *kb));
  return made;
}

Channel::Fill SocketChannel::outbound() noexcept {
  int waits = 0;
  if (::ioctl(socket_.get(), SIOCOUTQ, &waits) != 0) return {};
  return {static_cast<std::uint64_t>(waits), static_cast<std::uint64_t>(room_behind(socket_.get()))};
}

Result<> SocketChannel::send(const Message& message) {
  Datagram datagram;
  msghdr header;
  if (const auto filled = datagram.fill(message, header); !filled) return filled;
  if (::sendmsg(socket_.get(), &header, MSG_DONTWAIT | MSG_NOSIGNAL) < 0) return fail(send_error(errno));
  return ok();
}

std::size_t SocketChannel::send_all(std::span<const Message> messages) {
  std::array<Datagram, most_at_once> datagrams;
  std::array<mmsghdr, most_at_once> headers;
  std::size_t sent = 0;
  while (sent < messages.size()) {
    std::size_t ready = 0;
    while (ready < most_at_once && sent + ready < messages.size() &&
           datagrams[ready].fill(messages[sent + ready], headers[ready].msg_hdr))
      ++ready;
    const int taken = ready == 0 ? 0
                                 : ::sendmmsg(socket_.get(), headers.data(), static_cast<unsigned>(ready),
                                              MSG_DONTWAIT | MSG_NOSIGNAL);
    if (taken > 0) sent += static_cast<std::size_t>(taken);
    if (taken < static_cast<int>(most_at_once)) return sent;
  }
  return sent;
}

Result<Channel::Found> SocketChannel::receive(MessageBuffer& buffer) {
  std::array<std::byte, envelope::octets> head;
  std::array<iovec, 2> parts{iovec{head.data(), head.size()}, iovec{buffer.octets.data(), buffer.octets.size()}};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(noticed_descriptors * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = parts.data();
  header.msg_iovlen = parts.size();
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  const ssize_t octets = ::recvmsg(socket_.get(), &header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (octets < 0 && (errno == EAGAIN || errno == EINTR)) return Found{};
  if (octets < 0) {
    return errno == ECONNRESET ? fail(ErrorCode::Unavailable, "peer of control channel is gone", errno)
                               : fail(ErrorCode::SystemFailure, "receive on control channel", errno);
  }
  Arrived arrived = take_descriptors(header);
  if (octets == 0 && hung_up(socket_.get())) return fail(ErrorCode::Unavailable, "peer of control channel is gone");
  if ((header.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) != 0)
    return fail(ErrorCode::Malformed, "message is too long", octets);
  if (arrived.count > 1) return fail(ErrorCode::Malformed, "message carries several descriptors");
  OctetReader reader{Octets{head}.first(std::min(static_cast<std::size_t>(octets), head.size()))};
  auto message = envelope::read(reader);
  if (!message) {
    if (message.error().code == ErrorCode::Mismatch)
      foreign_version_ = static_cast<std::uint8_t>(message.error().value);
    return fail(message.error());
  }
  message->packet = Octets{buffer.octets}.first(static_cast<std::size_t>(octets) - envelope::octets);
  if (arrived.first) message->memory = SealedMemory::adopt(std::move(arrived.first));
  return Found{Flow::New, std::move(*message)};
}

}  // namespace hirosco
