// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>

#include "hirosco/descriptor/model/supervisor_apid.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// Space packets (CCSDS 133.0-B-2) and PUS-C secondary headers (ECSS-E-ST-70-41C). All length arithmetic of the project
/// lives here: a view that exists is a whole, well-formed packet.
namespace hirosco::pus {

using descriptor::supervisor_apid;

inline constexpr std::size_t primary_header_octets = 6;
inline constexpr std::size_t error_control_octets = 2;
inline constexpr std::size_t telecommand_overhead_octets = 13;  ///< headers and error control
inline constexpr std::size_t telemetry_overhead_octets = 22;  ///< headers, time and error control
inline constexpr std::size_t max_telecommand_octets = 4096;
inline constexpr std::size_t max_telemetry_octets = 4096;
inline constexpr std::uint16_t idle_apid = 2047;
inline constexpr std::uint16_t sequence_counts = 16'384;  ///< of a packet: one after the last is 0

/// Acknowledgement flags of a telecommand (docs/interfaces/packets.md).
enum Ack : std::uint8_t { ack_acceptance = 1, ack_start = 2, ack_progress = 4, ack_completion = 8, ack_all = 15 };

/// Total length that a primary header announces, 7 .. 65,542; for cutting a stream. `header` has at least 6 octets.
[[nodiscard]] std::size_t announced_octets(Octets header) noexcept;

/// The fields of a primary header, unchecked: what can be said of a damaged packet.
struct PrimaryHeader {
  std::uint8_t version{};
  bool telecommand{};
  bool secondary_header{};
  std::uint16_t apid{};
  std::uint8_t sequence_flags{};
  std::uint16_t sequence_count{};
  std::uint16_t data_length{};  ///< octets in the data field minus 1
  /// First four octets: the request id of ST[01].
  std::uint32_t request_id{};
};
/// Malformed: fewer than 6 octets.
[[nodiscard]] Result<PrimaryHeader> read_primary_header(Octets packet) noexcept;

/// The first check of acceptance: fewer than 6 octets, another version, telemetry or idle. Such a packet is discarded and counted
/// (idle ones not even that) without a report, though parse() says IllegalPrimaryHeader for want of a better notice.
[[nodiscard]] bool to_be_discarded(Octets packet) noexcept;

/// A whole, checked telecommand packet. Views the octets it was parsed from.  Realtime: bounded.
class TelecommandView {
 public:
  /// What of acceptance the packet itself shows, in the order of docs/interfaces/packets.md: the notice is what TM[1,2] must say.
  [[nodiscard]] static std::expected<TelecommandView, FailureNotice> parse(Octets packet) noexcept;

  [[nodiscard]] std::uint16_t apid() const noexcept { return u16(0) & 0x07FF; }
  [[nodiscard]] std::uint16_t sequence_count() const noexcept { return u16(2) & 0x3FFF; }
  [[nodiscard]] std::uint32_t request_id() const noexcept { return std::uint32_t{u16(0)} << 16 | u16(2); }
  [[nodiscard]] std::uint8_t ack() const noexcept { return u8(6) & 0x0F; }
  [[nodiscard]] std::uint8_t service() const noexcept { return u8(7); }
  [[nodiscard]] std::uint8_t subtype() const noexcept { return u8(8); }
  [[nodiscard]] std::uint16_t source() const noexcept { return u16(9); }
  [[nodiscard]] Octets application_data() const noexcept {
    return packet_.subspan(telecommand_data_at, packet_.size() - telecommand_overhead_octets);
  }
  [[nodiscard]] Octets packet() const noexcept { return packet_; }

 private:
  static constexpr std::size_t telecommand_data_at = telecommand_overhead_octets - error_control_octets;
  explicit TelecommandView(Octets packet) noexcept : packet_{packet} {}
  [[nodiscard]] std::uint8_t u8(std::size_t at) const noexcept { return std::to_integer<std::uint8_t>(packet_[at]); }
  [[nodiscard]] std::uint16_t u16(std::size_t at) const noexcept {
    return static_cast<std::uint16_t>(u8(at) << 8 | u8(at + 1));
  }
  Octets packet_;
};

/// A whole, checked telemetry packet with PUS-C secondary header.
class TelemetryView {
 public:
  [[nodiscard]] static Result<TelemetryView> parse(Octets packet) noexcept;

  [[nodiscard]] std::uint16_t apid() const noexcept;
  [[nodiscard]] std::uint16_t sequence_count() const noexcept;
  [[nodiscard]] std::uint8_t time_status() const noexcept;
  [[nodiscard]] std::uint8_t service() const noexcept;
  [[nodiscard]] std::uint8_t subtype() const noexcept;
  [[nodiscard]] std::uint16_t message_count() const noexcept;
  [[nodiscard]] std::uint16_t destination() const noexcept;
  [[nodiscard]] OnboardTime time() const noexcept;
  [[nodiscard]] Octets source_data() const noexcept;
  [[nodiscard]] Octets packet() const noexcept { return packet_; }

 private:
  explicit TelemetryView(Octets packet) noexcept : packet_{packet} {}
  Octets packet_;
};

struct TelecommandHeader {
  std::uint16_t apid{};
  std::uint16_t sequence_count{};
  std::uint8_t ack{ack_acceptance | ack_completion};
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::uint16_t source{};
};
struct TelemetryHeader {
  std::uint16_t apid{};
  std::uint16_t sequence_count{};
  std::uint8_t time_status{0};
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::uint16_t message_count{};
  std::uint16_t destination{};
  OnboardTime time{};
};

/// Writes a whole packet into `buffer` and returns the part used. ResourceExhausted: buffer or packet limit too small;
/// OutOfRange: APID above 2046.  Realtime: bounded, does not allocate.
[[nodiscard]] Result<Octets> write_telecommand(MutableOctets buffer, const TelecommandHeader& header,
                                               Octets application_data) noexcept;
[[nodiscard]] Result<Octets> write_telemetry(MutableOctets buffer, const TelemetryHeader& header,
                                             Octets source_data) noexcept;

}  // namespace hirosco::pus
