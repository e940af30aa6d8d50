// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/packet/packet.hpp"

#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/utilities/crc16.hpp"

namespace hirosco::pus {
namespace {

constexpr std::uint8_t pus_version = 2;
constexpr std::uint8_t unsegmented = 3;
constexpr std::uint16_t secondary_header_flag = 0x0800;
constexpr std::size_t telemetry_data_at = telemetry_overhead_octets - error_control_octets;
constexpr std::size_t telemetry_time_at = 13;

[[nodiscard]] std::uint8_t u8_at(Octets packet, std::size_t at) noexcept {
  return std::to_integer<std::uint8_t>(packet[at]);
}
[[nodiscard]] std::uint16_t u16_at(Octets packet, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(u8_at(packet, at) << 8 | u8_at(packet, at + 1));
}
[[nodiscard]] std::uint16_t apid_of(Octets packet) noexcept { return u16_at(packet, 0) & 0x07FF; }
[[nodiscard]] std::uint16_t count_of(Octets packet) noexcept { return u16_at(packet, 2) & 0x3FFF; }
[[nodiscard]] std::uint8_t sequence_flags_of(Octets packet) noexcept { return u8_at(packet, 2) >> 6; }

/// Another version, telemetry or idle, by the first two octets.
[[nodiscard]] bool is_no_telecommand(std::uint16_t identification) noexcept {
  return identification >> 12 != 1 || (identification & 0x07FF) == idle_apid;
}

void put_primary_header(OctetWriter& writer, bool telecommand, std::uint16_t apid, std::uint16_t count,
                        std::size_t total) noexcept {
  const unsigned type = telecommand ? 0x1000 : 0;
  writer.put(static_cast<std::uint16_t>(type | secondary_header_flag | apid));
  writer.put(static_cast<std::uint16_t>(unsegmented << 14 | (count & 0x3FFFU)));
  writer.put(static_cast<std::uint16_t>(total - primary_header_octets - 1));
}

[[nodiscard]] Result<Octets> finish(OctetWriter& writer) noexcept {
  writer.put(crc16(writer.written()));
  if (!writer.good()) return fail(ErrorCode::Internal, "packet length");
  return writer.written();
}

[[nodiscard]] Result<> check_room(std::size_t total, std::size_t limit, std::size_t room, std::uint16_t apid) noexcept {
  if (apid >= idle_apid) return fail(ErrorCode::OutOfRange, "APID", apid);
  if (total > limit) return fail(ErrorCode::ResourceExhausted, "packet limit", static_cast<std::int64_t>(total));
  if (total > room) return fail(ErrorCode::ResourceExhausted, "packet buffer", static_cast<std::int64_t>(total));
  return ok();
}

// What parse() refuses is made apart from it: nothing of what passes, which is nearly all, waits for a notice's octets.
using Parsed = std::expected<TelecommandView, FailureNotice>;
[[nodiscard, gnu::cold, gnu::noinline]] Parsed refuse(FailureCode code) noexcept {
  return std::unexpected{FailureNotice{code}};
}
[[nodiscard, gnu::cold, gnu::noinline]] Parsed refuse_length(std::uint16_t announced) noexcept {
  return std::unexpected{FailureNotice{FailureCode::IllegalLength}.with(announced)};
}

}  // namespace

std::size_t announced_octets(Octets header) noexcept {
  return std::size_t{u16_at(header, 4)} + primary_header_octets + 1;
}

Result<PrimaryHeader> read_primary_header(Octets packet) noexcept {
  if (packet.size() < primary_header_octets)
    return fail(ErrorCode::Malformed, "shorter than a primary header", static_cast<std::int64_t>(packet.size()));
  PrimaryHeader header;
  const std::uint16_t identification = u16_at(packet, 0);
  header.version = static_cast<std::uint8_t>(identification >> 13);
  header.telecommand = (identification & 0x1000) != 0;
  header.secondary_header = (identification & secondary_header_flag) != 0;
  header.apid = identification & 0x07FF;
  header.sequence_flags = sequence_flags_of(packet);
  header.sequence_count = count_of(packet);
  header.data_length = u16_at(packet, 4);
  header.request_id = static_cast<std::uint32_t>(identification) << 16 | u16_at(packet, 2);
  return header;
}

bool to_be_discarded(Octets packet) noexcept {
  return packet.size() < primary_header_octets || is_no_telecommand(u16_at(packet, 0));
}

std::expected<TelecommandView, FailureNotice> TelecommandView::parse(Octets packet) noexcept {
  using enum FailureCode;
  if (to_be_discarded(packet)) return refuse(IllegalPrimaryHeader);
  if (packet.size() < telecommand_overhead_octets || packet.size() > max_telecommand_octets ||
      announced_octets(packet) != packet.size())
    return refuse_length(u16_at(packet, 4));
  if ((u16_at(packet, 0) & secondary_header_flag) == 0) return refuse(IllegalPrimaryHeader);
  if (sequence_flags_of(packet) != unsegmented) return refuse(IllegalSequenceFlags);
  if (crc16(packet) != 0) return refuse(ErrorControl);
  if (u8_at(packet, 6) >> 4 != pus_version) return refuse(IllegalPusVersion);
  return TelecommandView{packet};
}

Result<TelemetryView> TelemetryView::parse(Octets packet) noexcept {
  HIROSCO_TRY_LET(const PrimaryHeader header, read_primary_header(packet));
  if (packet.size() < telemetry_overhead_octets || packet.size() > max_telemetry_octets ||
      announced_octets(packet) != packet.size())
    return fail(ErrorCode::Malformed, "telemetry length", static_cast<std::int64_t>(packet.size()));
  if (header.version != 0 || header.telecommand || !header.secondary_header || header.apid == idle_apid ||
      header.sequence_flags != unsegmented)
    return fail(ErrorCode::Malformed, "telemetry primary header", header.request_id);
  if (crc16(packet) != 0) return fail(ErrorCode::Malformed, "telemetry error control");
  if (u8_at(packet, 6) >> 4 != pus_version)
    return fail(ErrorCode::Malformed, "telemetry PUS version", u8_at(packet, 6) >> 4);
  return TelemetryView{packet};
}

std::uint16_t TelemetryView::apid() const noexcept { return apid_of(packet_); }
std::uint16_t TelemetryView::sequence_count() const noexcept { return count_of(packet_); }
std::uint8_t TelemetryView::time_status() const noexcept { return u8_at(packet_, 6) & 0x0F; }
std::uint8_t TelemetryView::service() const noexcept { return u8_at(packet_, 7); }
std::uint8_t TelemetryView::subtype() const noexcept { return u8_at(packet_, 8); }
std::uint16_t TelemetryView::message_count() const noexcept { return u16_at(packet_, 9); }
std::uint16_t TelemetryView::destination() const noexcept { return u16_at(packet_, 11); }
OnboardTime TelemetryView::time() const noexcept { return from_cuc(packet_.subspan(telemetry_time_at, cuc_octets)); }
Octets TelemetryView::source_data() const noexcept {
  return packet_.subspan(telemetry_data_at, packet_.size() - telemetry_overhead_octets);
}

Result<Octets> write_telecommand(MutableOctets buffer, const TelecommandHeader& header,
                                 Octets application_data) noexcept {
  const std::size_t total = telecommand_overhead_octets + application_data.size();
  HIROSCO_TRY(check_room(total, max_telecommand_octets, buffer.size(), header.apid));
  OctetWriter writer{buffer};
  put_primary_header(writer, true, header.apid, header.sequence_count, total);
  writer.put(static_cast<std::uint8_t>(pus_version << 4 | (header.ack & 0x0F)));
  writer.put(header.service).put(header.subtype).put(header.source).put(application_data);
  return finish(writer);
}

Result<Octets> write_telemetry(MutableOctets buffer, const TelemetryHeader& header, Octets source_data) noexcept {
  const std::size_t total = telemetry_overhead_octets + source_data.size();
  HIROSCO_TRY(check_room(total, max_telemetry_octets, buffer.size(), header.apid));
  OctetWriter writer{buffer};
  put_primary_header(writer, false, header.apid, header.sequence_count, total);
  writer.put(static_cast<std::uint8_t>(pus_version << 4 | (header.time_status & 0x0F)));
  writer.put(header.service).put(header.subtype).put(header.message_count).put(header.destination);
  writer.put(Octets{to_cuc(header.time)}).put(source_data);
  return finish(writer);
}

}  // namespace hirosco::pus
