// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "hirosco/data_transfer/link/link.hpp"

/// A sample of a real-time link as one datagram (docs/interfaces/udp_link.md has it octet by octet), and what a consumer takes of all that
/// arrives. No socket here: tests and fuzzers read what a network could bring.
namespace hirosco {

/// Where things stand in a datagram, in octets; numbers most significant octet first, the payload as agreed.
namespace link_datagram {
inline constexpr std::uint32_t magic = 0x484C'4E4B;  ///< "HLNK"
inline constexpr std::uint16_t version = 1;
inline constexpr std::size_t payload_at = 56;
inline constexpr std::size_t sum_octets = 2;
inline constexpr std::size_t extra_octets = payload_at + sum_octets;
}  // namespace link_datagram

/// Octets of one sample: what the largest datagram of IPv4 (65,507) has room for.
inline constexpr std::uint32_t max_datagram_payload_octets = 65'507 - link_datagram::extra_octets;
[[nodiscard]] constexpr std::size_t link_datagram_octets(std::uint32_t payload_octets) noexcept {
  return payload_octets + link_datagram::extra_octets;
}

/// What differs from one datagram of a link to the next.
struct LinkDatagramHead {
  LinkStatus status{};
  std::uint64_t sequence{};  ///< of datagrams, from 1: which of two was sent later
  std::uint64_t count{};  ///< of the sample, from 1; 0: there is none yet, the payload means nothing
  TimePoint sampled_at{};
};

/// `to` has link_datagram_octets() and `payload` the agreed size (invariants).  Realtime: bounded.
void write_link_datagram(MutableOctets to, const LinkLayout& layout, const LinkDatagramHead& head,
                         Octets payload) noexcept;

/// What a consumer did not take, and why.
struct DatagramRefusals {
  std::uint64_t damaged{0};  ///< not of the form, or its check sum is wrong
  std::uint64_t foreign{0};  ///< whole, but of another handshake, link, layout or producer
  std::uint64_t late{0};  ///< doubled, or overtaken by a later one
};

/// Takes each datagram of one link at most once and none after a later one.  Realtime: bounded. Thread: one.
class LinkDatagramGate {
 public:
  explicit LinkDatagramGate(const LinkLayout& layout) noexcept;
  struct Taken {
    LinkDatagramHead head;
    Octets payload;  ///< in what was received
  };
  [[nodiscard]] std::optional<Taken> take(Octets received) noexcept;
  [[nodiscard]] const DatagramRefusals& refusals() const noexcept { return refusals_; }

 private:
  struct Agreed {
    std::uint8_t link;
    std::uint32_t epoch;
    std::uint32_t payload_octets;
    std::uint64_t layout_hash;
    std::uint64_t key;
    friend bool operator==(const Agreed&, const Agreed&) = default;
  };
  Agreed agreed_;
  LinkDatagramHead last_{};
  DatagramRefusals refusals_{};
};

}  // namespace hirosco
