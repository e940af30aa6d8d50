// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/downlink/downlink.hpp"

namespace hirosco::ground {
namespace {

constexpr std::uint16_t counts_before_zero = 16'384;

}  // namespace

void Downlink::begin(std::optional<OnboardTime> known_until) {
  known_until_ = known_until;
  stream_.clear();
  expected_.clear();
}

bool Downlink::receive(Octets octets) {
  stream_.insert(stream_.end(), octets.begin(), octets.end());
  std::size_t used = 0;
  bool good = true;
  while (stream_.size() - used >= pus::primary_header_octets) {
    const Octets rest = Octets{stream_}.subspan(used);
    const std::size_t size = pus::announced_octets(rest);
    const auto header = pus::read_primary_header(rest);
    good = size <= pus::max_telemetry_octets && header && !header->telecommand && header->version == 0;
    if (!good || rest.size() < size) break;
    take(rest.first(size));
    used += size;
  }
  stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(used));
  return good;
}

void Downlink::take(Octets octets) {
  const auto packet = pus::TelemetryView::parse(octets);
  if (!packet) {
    ++damaged_;
    return;
  }
  ++received_;
  if (known_until_ && packet->time() > *known_until_) hearers_.gap(*known_until_, packet->time());
  known_until_.reset();
  count_lost(*packet);
  hearers_.packet(*packet, octets);
}

void Downlink::count_lost(const pus::TelemetryView& packet) {
  const auto next = static_cast<std::uint16_t>((packet.sequence_count() + 1) % counts_before_zero);
  const auto [known, first] = expected_.try_emplace(packet.apid(), next, packet.time());
  if (first) return;
  const auto missing = static_cast<std::uint16_t>((packet.sequence_count() + counts_before_zero - known->second.first) %
                                                  counts_before_zero);
  // Half of the numbers back is a process that began again, or an old packet: nothing was lost.
  if (missing != 0 && missing < counts_before_zero / 2) {
    lost_ += missing;
    if (packet.time() > known->second.second) hearers_.gap(known->second.second, packet.time());
  }
  known->second = {next, packet.time()};
}

}  // namespace hirosco::ground
