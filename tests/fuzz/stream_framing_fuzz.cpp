// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/stream_framing.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "hirosco/utilities/crc16.hpp"
#include "tests/fuzz/fuzz.hpp"

/// A serial line or TCP stream to a device, whatever octets come, in whatever pieces: what is taken stands in the stream as a whole
/// frame of ours, how the stream was cut changes nothing, there is always room for more, and two longest frames behind the last
/// octet of nonsense a frame is found.
namespace {

using namespace hirosco;
using Frames = std::vector<std::vector<std::byte>>;

using fuzz::expect;

Frames frames_of(Octets stream, std::size_t piece) {
  StreamDeframer deframer;
  Frames found;
  while (!stream.empty()) {
    const MutableOctets room = deframer.room();
    expect(!room.empty(), "there is room for more");
    const std::size_t taken = std::min({piece, room.size(), stream.size()});
    std::ranges::copy(stream.first(taken), room.begin());
    deframer.received(taken);
    stream = stream.subspan(taken);
    while (const auto frame = deframer.next()) {
      expect(frame->size() <= max_frame_octets, "a frame is not longer than a flow carries");
      found.emplace_back(frame->begin(), frame->end());
    }
  }
  return found;
}

std::vector<std::byte> streamed(Octets frame) {
  std::array<std::byte, max_streamed_octets> buffer;
  const Octets made = write_streamed(buffer, frame);
  return {made.begin(), made.end()};
}

void check(const std::vector<std::byte>& stream, std::size_t piece) {
  const Frames whole = frames_of(stream, stream.size());
  expect(whole == frames_of(stream, piece), "how a stream is cut changes nothing");
  auto from = stream.begin();
  for (const auto& frame : whole) {
    const auto wire = streamed(frame);
    const auto place = std::search(from, stream.end(), wire.begin(), wire.end());
    expect(place != stream.end(), "what was taken stands in the stream, in its order");
    from = place + static_cast<std::ptrdiff_t>(wire.size());
    fuzz::taken();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets octets = std::as_bytes(std::span{data, size});
  if (octets.empty()) return 0;
  const std::size_t piece = 1 + data[0] % 61;
  std::vector<std::byte> stream{octets.begin(), octets.end()};
  check(stream, piece);

  // As heads and bodies with right checks, so that these hide nothing behind them: each run of octets behind an octet of its length,
  // every fourth one of them damaged.
  std::vector<std::byte> made;
  unsigned count = 0;
  for (Octets rest = octets; !rest.empty(); ++count) {
    const std::size_t length = std::min<std::size_t>(std::to_integer<std::size_t>(rest[0]), rest.size() - 1);
    auto wire = streamed(rest.subspan(1, length));
    if (count % 4 == 3) wire.erase(wire.begin() + static_cast<std::ptrdiff_t>(length / 2 + stream_head_octets));
    made.insert(made.end(), wire.begin(), wire.end());
    rest = rest.subspan(1 + length);
  }
  check(made, piece);

  // A head that promises what these two octets say, and the rest behind it.
  if (size > 2) {
    std::vector<std::byte> head{std::byte{0x48}, std::byte{0x53}, octets[0], octets[1]};
    const std::uint16_t sum = crc16(head);
    head.push_back(static_cast<std::byte>(sum & 0xFF));
    head.push_back(static_cast<std::byte>(sum >> 8));
    stream.insert(stream.begin(), head.begin(), head.end());
  }
  stream.resize(stream.size() + 2 * max_streamed_octets);
  const auto last = streamed(octets.first(std::min(size, max_frame_octets)));
  stream.insert(stream.end(), last.begin(), last.end());
  check(stream, piece);
  const Frames found = frames_of(stream, piece);
  expect(!found.empty() && std::ranges::equal(found.back(), octets.first(std::min(size, max_frame_octets))),
         "behind two longest frames of nothing its place is found again");
  return 0;
}
