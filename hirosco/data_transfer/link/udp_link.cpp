// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/udp_link.hpp"

#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/data_transfer/address/socket_address.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/sandbox.hpp"

namespace hirosco {
namespace {

/// Datagrams of one read, at most: more than fit the socket's buffer, so that a read sees its end.
constexpr int most_at_once = 64;
/// The end of a link is told this often at once, as one datagram alone may be lost.
constexpr int most_tellings = 3;
/// Which the buffer of a socket has room for, about; the system adds to each.
constexpr std::size_t waiting_datagrams = 8;
constexpr std::size_t added_by_system = 1024;

template <class Value>
Result<> set(const FileDescriptor& socket, int level, int option, Value value) noexcept {
  if (::setsockopt(socket.get(), level, option, &value, sizeof value) == 0) return ok();
  return fail(ErrorCode::SystemFailure, "option of a socket", errno);
}

/// A socket at this address, which has its port afterwards.
Result<FileDescriptor> stand_at(InternetAddress& address) {
  const bool sixth = address.family == InternetAddress::Family::Ipv6;
  FileDescriptor socket{::socket(sixth ? AF_INET6 : AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!socket) return fail(ErrorCode::SystemFailure, "make socket", errno);
  const SocketAddress place = socket_address(address);
  if (::bind(socket.get(), place.get(), place.octets) != 0)
    return fail(ErrorCode::Unavailable,
                errno == EADDRINUSE ? "the port of a link is taken" : "a link's address is not of this computer",
                errno);
  const auto own = own_internet_address(socket.get());
  if (!own) return fail(ErrorCode::SystemFailure, "ask for the port of a socket", errno);
  address.port = own->port;
  return socket;
}

Result<> connect_to(const FileDescriptor& socket, const InternetAddress& address) {
  const SocketAddress place = socket_address(address);
  if (::connect(socket.get(), place.get(), place.octets) == 0) return ok();
  return fail(ErrorCode::Unavailable, "there is no way to the other end of a link", errno);
}

/// Of a socket's buffer, for so many datagrams.
int octets_of(std::size_t datagrams, const LinkLayout& layout) noexcept {
  return static_cast<int>(datagrams * (link_datagram_octets(layout.payload_octets) + added_by_system));
}

bool possible(const LinkLayout& layout) noexcept {
  return layout.payload_octets >= 1 && layout.payload_octets <= max_datagram_payload_octets && layout.depth == 0 &&
         !layout.wakes;
}

// --- the producer's end ----------------------------------------------------------------------------------------------

class Writer final : public UdpWriter {
 public:
  Writer(FileDescriptor socket, const InternetAddress& own, const LinkLayout& layout)
      : socket_{std::move(socket)},
        own_{own},
        layout_{layout},
        datagram_(link_datagram_octets(layout.payload_octets)),
        payload_(layout.payload_octets) {}

  void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept override {
    assert(payload.size() == payload_.size());
    std::memcpy(payload_.data(), payload.data(), payload.size());
    head_.status = status;
    ++head_.count;
    head_.sampled_at = sampled_at;
    send();
  }
  /// With the newest sample, so that no consumer has the one without the other.
  void set_status(LinkStatus status) noexcept override {
    head_.status = status;
    for (int telling = 0; telling < most_tellings; ++telling) send();
  }
  [[nodiscard]] LinkRoute route() const override {
    return {.link = layout_.route.link, .producer = to_text(own_), .consumer = {}, .key = layout_.route.key};
  }
  Result<> reach(const std::string& consumer) override {
    HIROSCO_TRY_LET(const InternetAddress there, read_internet_address(consumer));
    if (there.family != own_.family || there.port == 0)
      return fail(ErrorCode::Mismatch, "the address of a consumer cannot be reached from this end's");
    reached_.store(false, std::memory_order_relaxed);
    HIROSCO_TRY(connect_to(socket_, there));
    HIROSCO_TRY(fits_the_way());
    reached_.store(true, std::memory_order_release);
    return ok();
  }
  [[nodiscard]] std::uint64_t unsent() const noexcept override { return unsent_; }

 private:
  /// A sample in pieces is lost with any of them, and pieces wait in the receiver for those that never come.
  [[nodiscard]] Result<> fits_the_way() const {
    const bool sixth = own_.family == InternetAddress::Family::Ipv6;
    int widest = 0;
    socklen_t octets = sizeof widest;
    if (::getsockopt(socket_.get(), sixth ? static_cast<int>(IPPROTO_IPV6) : static_cast<int>(IPPROTO_IP),
                     sixth ? IPV6_MTU : IP_MTU, &widest, &octets) != 0)
      return fail(ErrorCode::SystemFailure, "ask for the MTU of a way", errno);
    const std::size_t heads = sixth ? 40 + 8 : 20 + 8;
    if (datagram_.size() + heads <= static_cast<std::size_t>(widest)) return ok();
    return fail(ErrorCode::Mismatch, "a sample does not fit the MTU of its way", widest);
  }
  void send() noexcept {
    ++head_.sequence;
    if (!reached_.load(std::memory_order_acquire)) return;
    write_link_datagram(datagram_, layout_, head_, payload_);
    if (::send(socket_.get(), datagram_.data(), datagram_.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0) ++unsent_;
  }

  FileDescriptor socket_;
  InternetAddress own_;
  LinkLayout layout_;
  LinkDatagramHead head_{};
  std::vector<std::byte> datagram_;
  std::vector<std::byte> payload_;  ///< of the newest sample
  std::atomic<bool> reached_{false};
  std::uint64_t unsent_{0};
};

// --- a consumer's end ------------------------------------------------------------------------------------------------

class Reader final : public UdpReader {
 public:
  Reader(FileDescriptor socket, const InternetAddress& own, const LinkLayout& layout)
      : socket_{std::move(socket)},
        own_{own},
        gate_{layout},
        link_{layout.route.link},
        received_(link_datagram_octets(layout.payload_octets) + 1),
        kept_(layout.payload_octets),
        arriving_(layout.payload_octets) {}

  LinkSample read(MutableOctets payload) noexcept override {
    assert(payload.size() == kept_.size());
    LinkSample newest = last_;
    const bool emptied = drain(newest);
    last_.status = newest.status;
    // Where the system let go of what came last, what is here is older than it looks: after a pause a consumer would take
    // for fresh what is from its beginning. The next datagram is.
    if (newest.count == last_.count || !emptied) return last(payload);
    newest.flow = Flow::New;
    newest.lost = last_.count == 0 ? 0 : newest.count - last_.count - 1;
    std::swap(kept_, arriving_);
    last_ = newest;
    std::memcpy(payload.data(), kept_.data(), kept_.size());
    return newest;
  }
  [[nodiscard]] LinkRoute route() const override {
    return {.link = link_, .producer = {}, .consumer = to_text(own_), .key = 0};
  }
  [[nodiscard]] const DatagramRefusals& refusals() const noexcept override { return gate_.refusals(); }

 private:
  /// Everything that waits; false when there was more, or the system had no room for some.
  [[nodiscard]] bool drain(LinkSample& newest) noexcept {
    for (int taken = 0; taken < most_at_once; ++taken) {
      const ssize_t octets = ::recv(socket_.get(), received_.data(), received_.size(), MSG_DONTWAIT);
      if (octets < 0) return taken < 2 || !overflowed();
      if (const auto datagram = gate_.take(Octets{received_}.first(static_cast<std::size_t>(octets)))) {
        newest.status = datagram->head.status;
        if (datagram->head.count == newest.count) continue;
        newest.count = datagram->head.count;
        newest.sampled_at = datagram->head.sampled_at;
        std::memcpy(arriving_.data(), datagram->payload.data(), arriving_.size());
      }
    }
    return false;
  }
  /// Since it was asked last. It cannot have where less than two waited.
  [[nodiscard]] bool overflowed() noexcept {
    std::array<std::uint32_t, SK_MEMINFO_VARS> words{};
    socklen_t octets = sizeof words;
    if (::getsockopt(socket_.get(), SOL_SOCKET, SO_MEMINFO, words.data(), &octets) != 0) return true;
    return std::exchange(dropped_, words[SK_MEMINFO_DROPS]) != words[SK_MEMINFO_DROPS];
  }
  [[nodiscard]] LinkSample last(MutableOctets payload) const noexcept {
    LinkSample sample = last_;
    sample.lost = 0;
    sample.flow = last_.count == 0 ? Flow::None : Flow::Old;
    if (sample.flow == Flow::Old) std::memcpy(payload.data(), kept_.data(), kept_.size());
    return sample;
  }

  FileDescriptor socket_;
  InternetAddress own_;
  LinkDatagramGate gate_;
  std::uint8_t link_;
  LinkSample last_{};
  std::uint32_t dropped_{0};
  std::vector<std::byte> received_;  ///< one octet more than agreed: who is longer shows
  std::vector<std::byte> kept_;  ///< payload of last_
  std::vector<std::byte> arriving_;
};

}  // namespace

// --- the mechanism ---------------------------------------------------------------------------------------------------

Result<MemoryHandle> UdpLink::establish(MemoryProvider&, const LinkLayout& layout) const {
  if (!possible(layout)) return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  return MemoryHandle{};
}

Result<std::unique_ptr<LinkWriter>> UdpLink::produce(MemoryProvider&, const MemoryHandle&,
                                                     const LinkLayout& layout) const {
  if (!possible(layout)) return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  HIROSCO_TRY_LET(InternetAddress own, read_internet_address(layout.route.producer));
  HIROSCO_TRY_LET(FileDescriptor socket, stand_at(own));
  const bool sixth = own.family == InternetAddress::Family::Ipv6;
  HIROSCO_TRY(sixth ? set(socket, IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_DO)
                    : set(socket, IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_DO));
  HIROSCO_TRY(set(socket, SOL_SOCKET, SO_SNDBUF, octets_of(waiting_datagrams, layout)));
  LinkLayout told = layout;
  if (::getrandom(&told.route.key, sizeof told.route.key, 0) != static_cast<ssize_t>(sizeof told.route.key))
    return fail(ErrorCode::SystemFailure, "key of a link", errno);
  return std::make_unique<Writer>(std::move(socket), own, told);
}

Result<std::unique_ptr<LinkReader>> UdpLink::consume(MemoryProvider&, const MemoryHandle&,
                                                     const LinkLayout& layout) const {
  if (!possible(layout)) return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  HIROSCO_TRY_LET(const InternetAddress producer, read_internet_address(layout.route.producer));
  HIROSCO_TRY_LET(InternetAddress own, read_internet_address(layout.route.consumer));
  if (producer.family != own.family || producer.port == 0)
    return fail(ErrorCode::Mismatch, "the address of a producer cannot be heard at this end's");
  HIROSCO_TRY_LET(FileDescriptor socket, stand_at(own));
  HIROSCO_TRY(set(socket, SOL_SOCKET, SO_RCVBUF, octets_of(waiting_datagrams, layout)));
  int granted = 0;
  socklen_t octets = sizeof granted;
  // The system grants twice what was asked for, for its own use, and no more than it allows anybody.
  if (::getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &granted, &octets) != 0 || granted < octets_of(2, layout))
    return fail(ErrorCode::ResourceExhausted, "the buffer of a socket (net.core.rmem_max) holds no two samples",
                granted);
  HIROSCO_TRY(connect_to(socket, producer));
  return std::make_unique<Reader>(std::move(socket), own, layout);
}

Result<std::unique_ptr<LinkView>> UdpLink::look(MemoryProvider&, const MemoryHandle&) const {
  return fail(ErrorCode::Unavailable, "samples of such a link pass nobody but their consumer");
}

void UdpLink::let_in(Sandbox& sandbox) const { sandbox.sockets.datagrams = true; }

}  // namespace hirosco
