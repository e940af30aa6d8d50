// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/power_frame.hpp"

#include <limits>

#include "hirosco/utilities/crc16.hpp"

namespace hirosco {
namespace {

// Apart in more than one bit from each other and from the kinds of device and enable frames.
enum class PowerKind : std::uint8_t { Command = 0x96, Status = 0xE9 };

[[nodiscard]] bool is_power_kind(std::uint8_t found) noexcept {
  return found == static_cast<std::uint8_t>(PowerKind::Command) ||
         found == static_cast<std::uint8_t>(PowerKind::Status);
}

struct PowerParts {
  bool on{false};
  std::uint16_t off_after_ms{0};
  std::uint32_t sequence{0};
};

Result<Octets> write_power_frame(MutableOctets buffer, PowerKind kind, const PowerParts& frame) noexcept {
  if (buffer.size() < power_frame_octets)
    return fail(ErrorCode::ResourceExhausted, "buffer too small for a power frame");
  OctetWriter writer{buffer, std::endian::little};
  writer.put(power_frame_magic).put(static_cast<std::uint8_t>(kind)).put(static_cast<std::uint8_t>(frame.on ? 1 : 0));
  writer.put(frame.off_after_ms).put(frame.sequence);
  writer.put(crc16(writer.written()));
  return writer.written();
}

Result<PowerParts> read_power_frame(Octets octets, PowerKind kind) noexcept {
  if (octets.size() != power_frame_octets)
    return fail(ErrorCode::Malformed, "power frame length", static_cast<std::int64_t>(octets.size()));
  OctetReader reader{octets, std::endian::little};
  if (const auto magic = reader.get<std::uint16_t>(); magic != power_frame_magic)
    return fail(ErrorCode::Malformed, "power frame magic", magic);
  const auto found_kind = reader.get<std::uint8_t>();
  const auto on = reader.get<std::uint8_t>();
  PowerParts frame{.on = on == 1};
  frame.off_after_ms = reader.get<std::uint16_t>();
  frame.sequence = reader.get<std::uint32_t>();
  if (const auto sum = reader.get<std::uint16_t>(); sum != crc16(octets.first(power_frame_octets - 2)))
    return fail(ErrorCode::Malformed, "power frame checksum", sum);
  if (!is_power_kind(found_kind)) return fail(ErrorCode::Mismatch, "power frame of another version", found_kind);
  if (found_kind != static_cast<std::uint8_t>(kind)) return fail(ErrorCode::Malformed, "power frame kind", found_kind);
  if (on > 1) return fail(ErrorCode::Malformed, "power frame value", on);
  return frame;
}

}  // namespace

Result<Octets> write_power_command(MutableOctets buffer, const PowerCommand& command) noexcept {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(command.off_after).count();
  if (ms < 1 || ms > std::numeric_limits<std::uint16_t>::max()) return fail(ErrorCode::OutOfRange, "off after, ms", ms);
  return write_power_frame(buffer, PowerKind::Command, {command.on, static_cast<std::uint16_t>(ms), command.sequence});
}

Result<Octets> write_power_status(MutableOctets buffer, const PowerStatus& status) noexcept {
  return write_power_frame(buffer, PowerKind::Status, {status.on, 0, status.sequence});
}

Result<PowerCommand> read_power_command(Octets frame) noexcept {
  HIROSCO_TRY_LET(const PowerParts found, read_power_frame(frame, PowerKind::Command));
  if (found.off_after_ms == 0) return fail(ErrorCode::Malformed, "power frame time", 0);
  return PowerCommand{found.on, std::chrono::milliseconds{found.off_after_ms}, found.sequence};
}

Result<PowerStatus> read_power_status(Octets frame) noexcept {
  HIROSCO_TRY_LET(const PowerParts found, read_power_frame(frame, PowerKind::Status));
  return PowerStatus{found.on, found.sequence};
}

}  // namespace hirosco
