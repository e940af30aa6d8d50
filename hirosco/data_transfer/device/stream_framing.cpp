// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/stream_framing.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "hirosco/utilities/crc16.hpp"

namespace hirosco {
namespace {

constexpr std::size_t checked_head_octets = 4;

struct Head {
  bool good{false};
  std::size_t octets{0};
};

[[nodiscard]] Head read_head(Octets head) noexcept {
  OctetReader reader{head, std::endian::little};
  const auto sync = reader.get<std::uint16_t>(), octets = reader.get<std::uint16_t>(),
             check = reader.get<std::uint16_t>();
  return {sync == stream_sync && octets <= max_frame_octets && check == crc16(head.first(checked_head_octets)), octets};
}

}  // namespace

Octets write_streamed(MutableOctets buffer, Octets frame) noexcept {
  if (frame.size() > max_frame_octets) return {};
  OctetWriter writer{buffer, std::endian::little};
  writer.put(stream_sync).put(static_cast<std::uint16_t>(frame.size()));
  if (!writer.good()) return {};
  writer.put(crc16(writer.written())).put(frame).put(crc16(frame));
  return writer.good() ? writer.written() : Octets{};
}

MutableOctets StreamDeframer::room() noexcept {
  if (begin_ != 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    suspect_end_ -= std::min(suspect_end_, begin_);
    begin_ = 0;
  }
  return MutableOctets{buffer_}.subspan(end_);
}

std::optional<Octets> StreamDeframer::next() noexcept {
  while (end_ - begin_ >= stream_head_octets) {
    const Octets waiting = Octets{buffer_}.subspan(begin_, end_ - begin_);
    const Head head = read_head(waiting.first(stream_head_octets));
    if (!head.good) {
      if (!std::exchange(lost_, true)) ++damaged_;
      skip_to_sync();
      continue;
    }
    const std::size_t whole = head.octets + stream_overhead_octets;
    if (waiting.size() < whole) return std::nullopt;
    const Octets frame = waiting.subspan(stream_head_octets, head.octets);
    OctetReader check{waiting.subspan(stream_head_octets + head.octets, 2), std::endian::little};
    if (check.get<std::uint16_t>() == crc16(frame)) {
      lost_ = false;
      begin_ += whole;
      return frame;
    }
    // Octets of it may be missing, and then the next head lies in it. Inside of such a one nothing is looked into again.
    lost_ = true;
    const std::size_t end = begin_ + whole;
    if (begin_ >= suspect_end_) {
      ++damaged_;
      begin_ += stream_head_octets;
      suspect_end_ = end;
    } else begin_ = end;
  }
  return std::nullopt;
}

/// At least one octet further, to where the next head may begin.
void StreamDeframer::skip_to_sync() noexcept {
  const auto first = static_cast<std::byte>(stream_sync & 0xFF);
  const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(end_);
  begin_ = static_cast<std::size_t>(std::find(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_) + 1, end, first) -
                                    buffer_.begin());
}

std::uint32_t StreamDeframer::take_damaged() noexcept { return std::exchange(damaged_, 0); }

void StreamDeframer::restart() noexcept {
  begin_ = end_ = suspect_end_ = 0;
  lost_ = false;
}

}  // namespace hirosco
