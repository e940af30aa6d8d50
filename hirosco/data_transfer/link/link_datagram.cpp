// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/link_datagram.hpp"

#include <cassert>
#include <utility>

#include "hirosco/utilities/crc16.hpp"

namespace hirosco {

void write_link_datagram(MutableOctets to, const LinkLayout& layout, const LinkDatagramHead& head,
                         Octets payload) noexcept {
  assert(to.size() == link_datagram_octets(layout.payload_octets) && payload.size() == layout.payload_octets);
  OctetWriter out{to};
  out.put(link_datagram::magic).put(link_datagram::version).put(layout.route.link);
  out.put(static_cast<std::uint8_t>(std::to_underlying(head.status)));
  out.put(layout.epoch).put(layout.payload_octets).put(layout.layout_hash).put(layout.route.key);
  out.put(head.sequence).put(head.count).put(static_cast<std::int64_t>(head.sampled_at.time_since_epoch().count()));
  out.put(payload).put(crc16(out.written()));
}

LinkDatagramGate::LinkDatagramGate(const LinkLayout& layout) noexcept
    : agreed_{layout.route.link, layout.epoch, layout.payload_octets, layout.layout_hash, layout.route.key} {}

std::optional<LinkDatagramGate::Taken> LinkDatagramGate::take(Octets received) noexcept {
  constexpr auto worst = static_cast<std::uint8_t>(std::to_underlying(LinkStatus::Fault));
  // Over octets that end with their own check sum it is 0.
  if (received.size() < link_datagram::extra_octets || crc16(received) != 0) {
    ++refusals_.damaged;
    return std::nullopt;
  }
  OctetReader in{received.first(received.size() - link_datagram::sum_octets)};
  const bool ours =
      in.get<std::uint32_t>() == link_datagram::magic && in.get<std::uint16_t>() == link_datagram::version;
  Agreed said{};
  said.link = in.get<std::uint8_t>();
  const auto status = in.get<std::uint8_t>();
  said.epoch = in.get<std::uint32_t>();
  said.payload_octets = in.get<std::uint32_t>();
  said.layout_hash = in.get<std::uint64_t>();
  said.key = in.get<std::uint64_t>();
  LinkDatagramHead head;
  head.sequence = in.get<std::uint64_t>();
  head.count = in.get<std::uint64_t>();
  head.sampled_at = TimePoint{Duration{in.get<std::int64_t>()}};
  const Octets payload = in.rest();
  if (!ours || payload.size() != said.payload_octets || status > worst || head.count > head.sequence) {
    ++refusals_.damaged;
    return std::nullopt;
  }
  head.status = LinkStatus{status};
  if (said != agreed_) {
    ++refusals_.foreign;
    return std::nullopt;
  }
  // A later datagram with an earlier sample is nothing that a producer sends.
  if (head.sequence <= last_.sequence || head.count < last_.count) {
    ++refusals_.late;
    return std::nullopt;
  }
  last_ = head;
  return Taken{head, payload};
}

}  // namespace hirosco
