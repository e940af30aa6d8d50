// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/acquisition.hpp"

#include <algorithm>
#include <span>

namespace hirosco::imager {
namespace {

/// Without a packet that is new for so long, the exposure not counted, an image is lost.
constexpr Duration packets_patience = std::chrono::seconds{1};

}  // namespace

bool Acquisition::begin(TimePoint now, const Window& window, float exposure_ms, std::uint8_t threshold) noexcept {
  place_ = store_.begin();
  if (place_.empty()) return false;
  // A camera that has gone on without us has numbers of before: none is given twice.
  number_ = std::max(number_, command_.input().image) + 1;
  command_.output() = {number_,      exposure_ms,   window.x,       window.y,
                       window.width, window.height, window.binning, threshold};
  readout_.begin(number_, window.pixels());
  coming_ = {.number = number_, .exposed = now, .window = window, .exposure_ms = exposure_ms};
  const auto exposure = std::chrono::microseconds{static_cast<std::int64_t>(1000 * exposure_ms)};
  lost_at_ = now + exposure + packets_patience;
  lent_place_ = lent_.lend();
  under_way_ = true;
  return true;
}

Acquisition::Fate Acquisition::read_out(TimePoint now, float temperature_c) noexcept {
  if (command_.fresh() && command_.input().image == number_ && command_.input().refused != 0) {
    under_way_ = false;
    return Fate::Refused;
  }
  // A link that came or went in between has another place: this image is not lent.
  if (lent_.lend() != lent_place_) lent_place_ = nullptr;
  if (packets_.fresh()) take_packet(now);
  if (readout_.complete()) {
    keep(temperature_c);
    return Fate::Kept;
  }
  if (now < lost_at_) return Fate::UnderWay;
  under_way_ = false;
  return Fate::Lost;
}

void Acquisition::take_packet(TimePoint now) noexcept {
  const Packet& packet = packets_.input();
  const PacketHead head{packet.image, packet.packets, packet.packet, packet.start, packet.pixels, packet.octets};
  const Readout::Heard heard = readout_.look(head);
  if (heard == Readout::Heard::Nothing) return;
  const auto coded = std::span{packet.coded}.first(heard == Readout::Heard::Wanted ? head.octets : 0U);
  const auto unpacked_into = [&](MutableOctets pixels) {
    return unpack(coded, pixels.subspan(head.start, head.pixels));
  };
  if (heard == Readout::Heard::Wrong || !unpacked_into(place_)) {
    ++wrong_;
    return;
  }
  if (lent_place_ != nullptr) unpacked_into(std::as_writable_bytes(std::span{lent_place_->pixel}));
  readout_.took(head);
  coming_.shutter = packet.shutter;
  lost_at_ = std::max(lost_at_, now + packets_patience);
}

void Acquisition::keep(float temperature_c) noexcept {
  coming_.temperature_c = temperature_c;
  store_.keep(coming_);
  under_way_ = false;
  if (lent_place_ == nullptr) return;
  const Window& window = coming_.window;
  Lent& lent = *lent_place_;
  lent.number = coming_.number;
  lent.width = window.columns();
  lent.height = window.rows();
  lent.x = window.x;
  lent.y = window.y;
  lent.binning = window.binning;
  lent.shutter = coming_.shutter;
  lent.exposure_ms = coming_.exposure_ms;
  lent_.publish();
}

}  // namespace hirosco::imager
