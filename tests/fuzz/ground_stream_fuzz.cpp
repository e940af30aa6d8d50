// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "subsystems/communication/ground_clients.hpp"
#include "tests/fuzz/fuzz.hpp"

/// What a client of the ground link sends, whatever octets and in whatever pieces: what is handed on has the length that it announces and the form of a
/// telecommand, is the same however the stream was cut, and nothing comes of a stream that is spoilt.
namespace {

using namespace hirosco;
using namespace hirosco::communication;
using fuzz::expect;

struct Cut {
  std::vector<std::vector<std::byte>> packets;
  std::uint64_t idle{0};
  std::optional<CloseReason> spoilt;
  friend bool operator==(const Cut&, const Cut&) = default;
};

[[nodiscard]] Cut cut(Octets stream, std::size_t piece) {
  Deframer deframer;
  Cut found;
  while (!stream.empty() && !deframer.spoilt()) {
    const MutableOctets room = deframer.room();
    expect(!room.empty(), "there is room where nothing waits");
    const Octets next = stream.first(std::min({piece, room.size(), stream.size()}));
    std::ranges::copy(next, room.begin());
    deframer.put(next.size(), {});
    stream = stream.subspan(next.size());
    expect(deframer.held_octets() <= Deframer::capacity, "no more is held than there is room for");
    for (; !deframer.front().empty(); deframer.pop({})) {
      const Octets packet = deframer.front();
      expect(packet.size() >= pus::primary_header_octets && pus::announced_octets(packet) == packet.size() &&
                 !pus::to_be_discarded(packet),
             "what is handed on has the form of a telecommand");
      found.packets.emplace_back(packet.begin(), packet.end());
      fuzz::taken();
    }
  }
  deframer.end();
  expect(deframer.room().empty(), "a stream that has ended takes nothing");
  found.idle = deframer.idle_packets();
  found.spoilt = deframer.spoilt();
  return found;
}

}  // namespace

/// The first octet says how long the pieces are.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Octets stream = fuzz::octets_of(data, size).subspan(1);
  const Cut whole = cut(stream, std::max<std::size_t>(stream.size(), 1));
  expect(whole == cut(stream, 1 + data[0] % 40), "how a stream is cut changes nothing");
  return 0;
}
