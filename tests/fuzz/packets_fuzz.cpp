// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <vector>

#include "ground/downlink/downlink.hpp"
#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "tests/fuzz/fuzz.hpp"

/// Space packets and their times, and the stream that ground cuts into packets, from whatever octets come: what is taken is written to the
/// octets that it came from, and is the same in whatever pieces it arrives.
namespace {

using namespace hirosco;
using fuzz::expect;

void check_telecommand(Octets octets) {
  const auto packet = pus::TelecommandView::parse(octets);
  const auto header = pus::read_primary_header(octets);
  expect(header.has_value() == (octets.size() >= pus::primary_header_octets), "a primary header is six octets");
  if (pus::to_be_discarded(octets)) expect(!packet, "what is discarded is no telecommand");
  if (!packet) return;
  fuzz::taken();
  expect(header->telecommand && header->apid == packet->apid() && header->request_id == packet->request_id() &&
             header->sequence_count == packet->sequence_count(),
         "a header is one, however it is read");
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const auto again = pus::write_telecommand(buffer,
                                            {.apid = packet->apid(),
                                             .sequence_count = packet->sequence_count(),
                                             .ack = packet->ack(),
                                             .service = packet->service(),
                                             .subtype = packet->subtype(),
                                             .source = packet->source()},
                                            packet->application_data());
  expect(again && std::ranges::equal(*again, octets), "a telecommand is the octets that it came from");
}

void check_telemetry(Octets octets) {
  const auto packet = pus::TelemetryView::parse(octets);
  if (!packet) return;
  fuzz::taken();
  std::array<std::byte, pus::max_telemetry_octets> buffer;
  const auto again = pus::write_telemetry(buffer,
                                          {.apid = packet->apid(),
                                           .sequence_count = packet->sequence_count(),
                                           .time_status = packet->time_status(),
                                           .service = packet->service(),
                                           .subtype = packet->subtype(),
                                           .message_count = packet->message_count(),
                                           .destination = packet->destination(),
                                           .time = packet->time()},
                                          packet->source_data());
  expect(again && std::ranges::equal(*again, octets), "a report is the octets that it came from");
}

void check_time(Octets octets) {
  const auto time = pus::read_cuc(octets);
  if (!time) return;
  fuzz::taken();
  std::array<std::byte, 16> buffer;
  const auto written = pus::write_cuc(buffer, *time);
  // Four octets of fraction are finer than a nanosecond: the last of them are the next second, which may be one too many.
  if (!written) {
    expect(time->time.time_since_epoch() % std::chrono::seconds{1} == Duration{},
           "a time that was read can be written");
    return;
  }
  const auto again = pus::read_cuc(Octets{buffer}.first(*written));
  expect(again && again->time == time->time && again->format == time->format, "a time is written and read the same");
}

/// What a stream had.
struct Cut {
  std::vector<std::vector<std::byte>> packets;
  std::size_t gaps{0};
  std::uint64_t lost{0}, damaged{0};
  bool good{true};
  friend bool operator==(const Cut&, const Cut&) = default;
};

[[nodiscard]] Cut cut(Octets stream, std::size_t piece) {
  Cut found;
  ground::Downlink downlink{{.packet = [&](const pus::TelemetryView&,
                                           Octets octets) { found.packets.emplace_back(octets.begin(), octets.end()); },
                             .gap =
                                 [&](OnboardTime from, OnboardTime to) {
                                   expect(from < to, "a gap begins before it ends");
                                   ++found.gaps;
                                 }}};
  downlink.begin(OnboardTime{});
  while (!stream.empty() && found.good) {
    const Octets next = stream.first(std::min(piece, stream.size()));
    found.good = downlink.receive(next);
    stream = stream.subspan(next.size());
  }
  found.lost = downlink.lost();
  found.damaged = downlink.damaged();
  expect(downlink.received() == found.packets.size(), "what is counted was handed on");
  return found;
}

/// As if its length and check sum were right.
[[nodiscard]] std::vector<std::byte> mended(Octets octets) {
  std::vector<std::byte> packet{octets.begin(), octets.end()};
  if (packet.size() >= pus::primary_header_octets) {
    OctetWriter length{MutableOctets{packet}.subspan(4, 2)};
    length.put(static_cast<std::uint16_t>(packet.size() + sizeof(std::uint16_t) - pus::primary_header_octets - 1));
  }
  return fuzz::with_crc16(packet);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets octets = fuzz::octets_of(data, size);
  const auto whole = mended(octets);
  for (const Octets each : {octets, Octets{whole}}) {
    check_telecommand(each);
    check_telemetry(each);
  }
  check_time(octets);

  // The first octet says how long the pieces are. Two packets of which the second is mended are a stream whose begin is anything.
  if (octets.empty()) return 0;
  const std::size_t piece = 1 + std::to_integer<std::size_t>(octets.front()) % 40;
  std::vector<std::byte> stream{whole};
  stream.insert(stream.end(), octets.begin() + 1, octets.end());
  expect(cut(stream, piece) == cut(stream, stream.size()), "in pieces there are the same packets");
  return 0;
}
