// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/link/link_datagram.hpp"

namespace hirosco {

/// The newest value by plain UDP, IPv4 or IPv6: each sample whole in one datagram that nobody on its way may cut in pieces
/// (docs/adr/0078). Both sockets are connected, so that the system keeps what others send out of them. What cannot be sent is
/// let go, and is one of those that the consumer tells as lost.
class UdpLink final : public LinkMechanism {
 public:
  [[nodiscard]] LinkMethod method() const noexcept override { return LinkMethod::Udp; }
  [[nodiscard]] LinkKind kind() const noexcept override { return LinkKind::Latest; }
  [[nodiscard]] bool in_memory() const noexcept override { return false; }
  [[nodiscard]] LinkEndsAt ends_at() const noexcept override { return LinkEndsAt::Addresses; }
  void let_in(Sandbox& sandbox) const override;
  [[nodiscard]] std::uint32_t max_payload() const noexcept override { return max_datagram_payload_octets; }
  /// Nothing is shared but addresses.
  [[nodiscard]] Result<MemoryHandle> establish(MemoryProvider& provider, const LinkLayout& layout) const override;
  /// Stands at the route's `producer`, which has a port afterwards. Unavailable: the address is not of this computer, or its
  /// port is taken.
  [[nodiscard]] Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  /// Stands at the route's `consumer` and hears its `producer` alone. Unavailable: as of produce().
  [[nodiscard]] Result<std::unique_ptr<LinkReader>> consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  /// Unavailable, always: samples pass nobody but their consumer.
  [[nodiscard]] Result<std::unique_ptr<LinkView>> look(MemoryProvider& provider,
                                                       const MemoryHandle& shared) const override;
};

/// A producer's end by UDP.  Realtime: one system call that does not block. Thread: one, and another one for reach().
class UdpWriter : public LinkWriter {
 public:
  /// Datagrams that were not sent: the system's buffer was full, nobody listens, there is no way, or it has become too narrow.
  [[nodiscard]] virtual std::uint64_t unsent() const noexcept = 0;
};
/// A consumer's end by UDP.  Realtime: at most 64 system calls that do not block. Thread: one.
class UdpReader : public LinkReader {
 public:
  [[nodiscard]] virtual const DatagramRefusals& refusals() const noexcept = 0;
};

}  // namespace hirosco
