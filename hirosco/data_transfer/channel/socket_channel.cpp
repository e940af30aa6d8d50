// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/socket_channel.hpp"

#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco {
namespace {

/// A packet of up to so many octets is copied behind its envelope: of two parts the system wants a list, which it has to fetch and check.
/// A longer one costs less as it is.
constexpr std::size_t copied_octets = 248;
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
    OctetWriter writer{beginning_};
    envelope::write(writer, message);
    const bool copied = message.packet.size() <= copied_octets;
    if (copied) writer.put(message.packet);
    parts_ = {iovec{beginning_.data(), writer.size()},
              iovec{const_cast<std::byte*>(message.packet.data()), message.packet.size()}};
    header = {};
    header.msg_iov = parts_.data();
    header.msg_iovlen = copied ? 1 : parts_.size();
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

  std::array<std::byte, envelope::octets + copied_octets> beginning_;
  std::array<iovec, 2> parts_;
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(int))> control_;
};

/// What one look at a socket has brought.
struct Arrived {
  ssize_t octets{0};  ///< below 0: errno says why none
  bool cut{false};  ///< more than there was room for
  FileDescriptor first;  ///< of the descriptors; the others are closed
  std::size_t descriptors{0};
};

void take_descriptors(msghdr& header, Arrived& arrived) noexcept {
  for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr; control = CMSG_NXTHDR(&header, control)) {
    if (control->cmsg_level != SOL_SOCKET || control->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (control->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(control) + i * sizeof number, sizeof number);
      FileDescriptor descriptor{number};
      if (arrived.descriptors++ == 0) arrived.first = std::move(descriptor);
    }
  }
}

/// One message in one piece: of two parts the system would want a list, as in Datagram.
[[nodiscard]] Arrived receive_with_descriptors(int socket, MutableOctets room) noexcept {
  iovec part{room.data(), room.size()};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(noticed_descriptors * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  Arrived arrived;
  arrived.octets = ::recvmsg(socket, &header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (arrived.octets < 0) return arrived;
  arrived.cut = (header.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) != 0;
  take_descriptors(header, arrived);
  return arrived;
}

/// Without a header, which the system would have to fetch and to give back; descriptors that came along are closed by it.
[[nodiscard]] Arrived receive_octets(int socket, MutableOctets room) noexcept {
  Arrived arrived;
  arrived.octets = ::recv(socket, room.data(), room.size(), MSG_DONTWAIT | MSG_TRUNC);  // how many there were
  arrived.cut = arrived.octets > static_cast<ssize_t>(room.size());
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
  constexpr int flags = MSG_DONTWAIT | MSG_NOSIGNAL;
  // Octets in one piece need no header, which the system would have to fetch as well.
  const bool plain = header.msg_iovlen == 1 && header.msg_controllen == 0;
  const ssize_t sent = plain ? ::send(socket_.get(), header.msg_iov->iov_base, header.msg_iov->iov_len, flags)
                             : ::sendmsg(socket_.get(), &header, flags);
  if (sent < 0) return fail(send_error(errno));
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
  std::array<std::byte, envelope::octets + max_packet_octets> whole;
  Arrived arrived =
      memory_ == Memory::Taken ? receive_with_descriptors(socket_.get(), whole) : receive_octets(socket_.get(), whole);
  if (arrived.octets < 0 && (errno == EAGAIN || errno == EINTR)) return Found{};
  if (arrived.octets < 0) {
    return errno == ECONNRESET ? fail(ErrorCode::Unavailable, "peer of control channel is gone", errno)
                               : fail(ErrorCode::SystemFailure, "receive on control channel", errno);
  }
  if (arrived.octets == 0 && hung_up(socket_.get()))
    return fail(ErrorCode::Unavailable, "peer of control channel is gone");
  if (arrived.cut) return fail(ErrorCode::Malformed, "message is too long", arrived.octets);
  if (arrived.descriptors > 1) return fail(ErrorCode::Malformed, "message carries several descriptors");
  OctetReader reader{Octets{whole}.first(static_cast<std::size_t>(arrived.octets))};
  auto message = envelope::read(reader);
  if (!message) {
    if (message.error().code == ErrorCode::Mismatch)
      foreign_version_ = static_cast<std::uint8_t>(message.error().value);
    return fail(message.error());
  }
  const Octets packet = reader.rest();
  copy_octets(packet, buffer.octets);
  message->packet = Octets{buffer.octets}.first(packet.size());
  if (arrived.first) message->memory = SealedMemory::adopt(std::move(arrived.first));
  return Found{Flow::New, std::move(*message)};
}

}  // namespace hirosco
