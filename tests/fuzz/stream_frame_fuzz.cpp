// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/stream_frame.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "hirosco/utilities/crc16.hpp"
#include "tests/fuzz/fuzz.hpp"

/// A stream of a member's frames, whatever octets come: what is taken is a whole frame of ours, and is written to the octets that it
/// came from; what waits for more waits for no more than a frame can have.
namespace {

using namespace hirosco;

using fuzz::expect;

[[nodiscard]] std::size_t number_at(Octets octets, std::size_t place) {
  return std::to_integer<std::size_t>(octets[place]) << 8 | std::to_integer<std::size_t>(octets[place + 1]);
}

void check_waiting(Octets received) {
  if (received.size() < stream_frame_head_octets) return;
  const std::size_t declared = number_at(received, 4);
  expect(declared <= max_stream_frame_payload, "a frame that is waited for has room");
  expect(received.size() < declared + stream_frame_extra_octets, "a whole frame is not waited for");
}

void check_taken(const StreamFrame& frame, Octets received) {
  expect(frame.octets == frame.payload.size() + stream_frame_extra_octets && frame.octets <= received.size(),
         "a frame is what was received");
  fuzz::taken();
  const auto kind = static_cast<unsigned>(frame.kind);
  expect(kind >= 1 && kind <= 3, "a frame is of a kind that there is");
  std::vector<std::byte> again(frame.octets);
  const std::size_t half = frame.payload.size() / 2;
  const auto written = write_stream_frame(again, frame.kind, frame.payload.first(half), frame.payload.subspan(half));
  expect(written && std::ranges::equal(*written, received.first(frame.octets)),
         "a frame is the octets that it came from");
  const auto cut = read_stream_frame(received.first(frame.octets - 1));
  expect(cut && !*cut, "a frame without its last octet is waited for");
}

/// Frame by frame, until one is wrong or not whole.
void check_stream(Octets received) {
  for (;;) {
    const auto found = read_stream_frame(received);
    if (!found) return;
    if (!*found) return check_waiting(received);
    check_taken(**found, received);
    received = received.subspan((*found)->octets);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets octets = std::as_bytes(std::span{data, size});
  check_stream(octets);

  // With the check sum that these octets have, so that it hides nothing behind it.
  std::vector<std::byte> sealed;
  sealed.reserve(size + 2);  // not one more, so that reading behind them shows
  sealed.assign(octets.begin(), octets.end());
  const std::uint16_t sum = crc16(octets);
  sealed.push_back(static_cast<std::byte>(sum >> 8));
  sealed.push_back(static_cast<std::byte>(sum & 0xFF));
  check_stream(sealed);
  return 0;
}
