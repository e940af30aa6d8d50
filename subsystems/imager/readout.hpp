// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "hirosco/utilities/octets.hpp"

/// How an image comes from its camera: in packets that are asked for by number, each packed by itself. No framework.
namespace hirosco::imager {

inline constexpr std::size_t most_pixels = 1U << 20;
inline constexpr std::size_t most_packets = 1200;
inline constexpr std::size_t packet_octets = 968;

/// What a camera says of one packet; from outside, so nothing of it is believed before it was looked at.
struct PacketHead {
  std::uint32_t image;  ///< 0: it has no such packet, or not yet
  std::uint16_t packets;  ///< of the image
  std::uint16_t packet;
  std::uint32_t start;  ///< first pixel
  std::uint32_t pixels;
  std::uint16_t octets;  ///< of PackBits
};

/// PackBits: an octet n from 0 to 127 is followed by n + 1 as they are, one from 129 to 255 by one that stands 257 - n times; 128 is nothing.
/// False: these octets do not make exactly so many pixels; some may have been written.  Realtime: bounded.
[[nodiscard]] inline bool unpack(std::span<const std::uint8_t> coded, MutableOctets pixels) noexcept {
  std::size_t from = 0, to = 0;
  while (from < coded.size()) {
    const std::uint8_t head = coded[from++];
    if (head == 128) continue;
    const std::size_t count = head < 128 ? head + std::size_t{1} : 257 - std::size_t{head};
    const std::size_t taken = head < 128 ? count : 1;
    if (count > pixels.size() - to || taken > coded.size() - from) return false;
    if (head < 128) std::memcpy(pixels.data() + to, coded.data() + from, count);
    else std::memset(pixels.data() + to, coded[from], count);
    from += taken;
    to += count;
  }
  return to == pixels.size();
}

/// Which packets of one image are there, and which to ask for next. In each cycle another one that is missing is asked for, whether the last
/// answer has come or not: an image takes about as many cycles as it has packets, and a lost one is asked for again in its turn.
class Readout {
 public:
  void begin(std::uint32_t image, std::uint32_t pixels) noexcept {
    image_ = image;
    pixels_ = pixels;
    packets_ = got_ = next_ = 0;
    covered_ = 0;
    there_.reset();
  }
  [[nodiscard]] std::uint32_t image() const noexcept { return image_; }
  [[nodiscard]] std::uint16_t got() const noexcept { return got_; }
  /// 0: not told yet.
  [[nodiscard]] std::uint16_t packets() const noexcept { return packets_; }
  [[nodiscard]] bool complete() const noexcept { return packets_ != 0 && got_ == packets_ && covered_ == pixels_; }

  enum class Heard : std::uint8_t { Nothing, Wanted, Wrong };
  /// Whether this is a packet of the image that is still missing. Wrong: it is of this image and cannot be.
  [[nodiscard]] Heard look(const PacketHead& head) const noexcept {
    if (head.image == 0 || head.image != image_) return Heard::Nothing;
    const bool possible = head.packets != 0 && head.packets <= most_packets && head.packet < head.packets &&
                          (packets_ == 0 || head.packets == packets_) && head.octets <= packet_octets &&
                          head.pixels != 0 && head.pixels <= pixels_ && head.start <= pixels_ - head.pixels;
    if (!possible) return Heard::Wrong;
    return there_[head.packet] ? Heard::Nothing : Heard::Wanted;
  }
  /// It was unpacked.
  void took(const PacketHead& head) noexcept {
    packets_ = head.packets;
    there_.set(head.packet);
    ++got_;
    covered_ += head.pixels;
  }
  /// The number of the packet to ask for in this cycle.  Realtime: bounded.
  [[nodiscard]] std::uint16_t ask() noexcept {
    if (packets_ == 0) return 0;
    for (std::uint16_t tried = 0; tried < packets_; ++tried) {
      next_ = static_cast<std::uint16_t>((next_ + 1) % packets_);
      if (!there_[next_]) break;
    }
    return next_;
  }

 private:
  std::uint32_t image_{0}, pixels_{0}, covered_{0};
  std::uint16_t packets_{0}, got_{0}, next_{0};
  std::bitset<most_packets> there_;
};

/// What is read of the sensor: binning x binning elements become one pixel.
struct Window {
  std::uint16_t x, y, width, height;  ///< elements
  std::uint8_t binning;

  [[nodiscard]] std::uint16_t columns() const noexcept { return static_cast<std::uint16_t>(width / binning); }
  [[nodiscard]] std::uint16_t rows() const noexcept { return static_cast<std::uint16_t>(height / binning); }
  [[nodiscard]] std::uint32_t pixels() const noexcept { return std::uint32_t{columns()} * rows(); }
  /// Null: it can be read of a sensor of this size; else in words why not.
  [[nodiscard]] const char* problem(std::uint16_t sensor_width, std::uint16_t sensor_height) const noexcept {
    if (binning == 0 || width == 0 || height == 0) return "an empty window";
    if (x + width > sensor_width) return "the window ends beyond the sensor's columns";
    if (y + height > sensor_height) return "the window ends beyond the sensor's rows";
    if (width % binning != 0 || height % binning != 0) return "the binning does not divide the window";
    return pixels() > most_pixels ? "more than 1 Mi pixels" : nullptr;
  }
};

}  // namespace hirosco::imager
