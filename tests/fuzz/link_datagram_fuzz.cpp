// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/link_datagram.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "hirosco/utilities/crc16.hpp"
#include "tests/fuzz/fuzz.hpp"

/// What a network may bring to a consumer of a link, one datagram after the other: what is taken was written by the producer of
/// this link, goes forward only, and is written to the octets that it came from.
namespace {

using namespace hirosco;

const LinkLayout layout{.epoch = 3,
                        .payload_octets = 8,
                        .layout_hash = 5,
                        .period = Duration{1},
                        .depth = 0,
                        .route = {.link = 2, .producer = {}, .consumer = {}, .key = 9}};

using fuzz::expect;

/// A datagram as `write_link_datagram` makes it is this one, octet by octet: nothing of it is unlooked at.
void check_taken(const LinkDatagramGate::Taken& taken, Octets received) {
  expect(std::to_underlying(taken.head.status) <= 4, "a status is one that there is");
  expect(taken.payload.size() == layout.payload_octets, "a payload has the agreed size");
  std::vector<std::byte> again(link_datagram_octets(layout.payload_octets));
  write_link_datagram(again, layout, taken.head, taken.payload);
  expect(std::ranges::equal(again, received), "a datagram is the octets that it came from");
}

class Consumer {
 public:
  void receive(Octets octets) {
    const auto taken = gate_.take(octets);
    const DatagramRefusals& no = gate_.refusals();
    expect(no.damaged + no.foreign + no.late + taken_ + (taken ? 1 : 0) == ++received_, "each is taken or counted");
    if (!taken) return;
    check_taken(*taken, octets);
    expect(taken->head.sequence > sequence_, "datagrams go forward");
    expect(taken->head.count >= count_, "samples go forward");
    sequence_ = taken->head.sequence;
    count_ = taken->head.count;
    ++taken_;
    fuzz::taken();
    expect(!gate_.take(octets), "nothing is taken twice");
    ++received_;
  }

 private:
  LinkDatagramGate gate_{layout};
  std::uint64_t received_{0}, taken_{0}, sequence_{0}, count_{0};
};

/// With the check sum that these octets have, so that it hides nothing behind it; no octet more, so that reading behind them shows.
std::vector<std::byte> sealed(Octets octets) {
  std::vector<std::byte> whole;
  whole.reserve(octets.size() + 2);
  whole.assign(octets.begin(), octets.end());
  const std::uint16_t sum = crc16(octets);
  whole.push_back(static_cast<std::byte>(sum >> 8));
  whole.push_back(static_cast<std::byte>(sum & 0xFF));
  return whole;
}

}  // namespace

/// The input is cut in datagrams of the right size, the last of which is what is left; and each is tried as it is, sealed, and
/// with the words of the agreement written into it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Octets left = std::as_bytes(std::span{data, size});
  const std::size_t each = link_datagram_octets(layout.payload_octets) - link_datagram::sum_octets;
  Consumer consumer;
  do {
    const Octets octets = left.first(std::min(each, left.size()));
    left = left.subspan(octets.size());
    consumer.receive(octets);
    consumer.receive(sealed(octets));
    if (octets.size() < link_datagram::payload_at) continue;
    std::vector<std::byte> agreed(octets.begin(), octets.end());
    std::vector<std::byte> pattern(link_datagram_octets(layout.payload_octets));
    write_link_datagram(pattern, layout, {}, std::vector<std::byte>(layout.payload_octets));
    std::copy_n(pattern.begin(), 7, agreed.begin());
    std::copy_n(pattern.begin() + 8, 24, agreed.begin() + 8);
    std::vector<std::byte> spoilt = sealed(agreed);
    spoilt.back() ^= std::byte{1};
    consumer.receive(spoilt);
    std::vector<std::byte> longer = agreed;
    longer.push_back(std::byte{0});
    consumer.receive(sealed(longer));
    consumer.receive(sealed(agreed));
  } while (!left.empty());
  return 0;
}
