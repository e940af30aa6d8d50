// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_frame.hpp"

#include "hirosco/utilities/crc16.hpp"

namespace hirosco {
namespace {

enum class Kind : std::uint8_t { Command = 1, Status = 2 };

[[nodiscard]] bool is_device_kind(std::uint8_t found) noexcept {
  return found == static_cast<std::uint8_t>(Kind::Command) || found == static_cast<std::uint8_t>(Kind::Status);
}

/// Both kinds share one layout; a field without meaning in a kind is sent as 0.
struct Frame {
  std::uint8_t mode{0};
  std::uint32_t epoch{0};
  std::uint32_t sequence{0};
  std::uint16_t flags{0};
  std::uint32_t watchdog_us{0};
  Octets payload;
};

Result<Octets> write_frame(MutableOctets buffer, Kind kind, const Frame& frame) noexcept {
  if (frame.payload.size() > max_device_payload_octets)
    return fail(ErrorCode::OutOfRange, "device payload too long", static_cast<std::int64_t>(frame.payload.size()));
  OctetWriter writer{buffer, std::endian::little};
  writer.put(device_frame_magic).put(static_cast<std::uint8_t>(kind)).put(frame.mode).put(frame.epoch);
  writer.put(frame.sequence).put(frame.flags).put(static_cast<std::uint16_t>(frame.payload.size()));
  writer.put(frame.watchdog_us).put(frame.payload);
  if (!writer.good()) return fail(ErrorCode::ResourceExhausted, "buffer too small for a device frame");
  writer.put(crc16(writer.written()));
  if (!writer.good()) return fail(ErrorCode::ResourceExhausted, "buffer too small for a device frame");
  return writer.written();
}

Result<Frame> read_frame(Octets octets, Kind kind) noexcept {
  const auto length = static_cast<std::int64_t>(octets.size());
  if (octets.size() < device_frame_overhead_octets || octets.size() > max_device_frame_octets)
    return fail(ErrorCode::Malformed, "device frame length", length);
  const Octets covered = octets.first(octets.size() - 2);
  OctetReader reader{octets, std::endian::little};
  if (const auto magic = reader.get<std::uint16_t>(); magic != device_frame_magic)
    return fail(ErrorCode::Malformed, "device frame magic", magic);
  const auto found_kind = reader.get<std::uint8_t>();
  OctetReader sum{octets.last(2), std::endian::little};
  const bool intact = sum.get<std::uint16_t>() == crc16(covered);
  // Before its parts are read: what lies where is known of this version only.
  if (intact && !is_device_kind(found_kind))
    return fail(ErrorCode::Mismatch, "device frame of another version", found_kind);
  Frame frame;
  frame.mode = reader.get<std::uint8_t>();
  frame.epoch = reader.get<std::uint32_t>();
  frame.sequence = reader.get<std::uint32_t>();
  frame.flags = reader.get<std::uint16_t>();
  const auto payload_octets = reader.get<std::uint16_t>();
  frame.watchdog_us = reader.get<std::uint32_t>();
  if (payload_octets != octets.size() - device_frame_overhead_octets)
    return fail(ErrorCode::Malformed, "device frame length", length);
  frame.payload = reader.get(payload_octets);
  if (!intact) return fail(ErrorCode::Malformed, "device frame checksum", reader.get<std::uint16_t>());
  // The kind is judged after the checksum: only an intact frame can tell that the two ends are swapped.
  if (found_kind != static_cast<std::uint8_t>(kind)) return fail(ErrorCode::Malformed, "device frame kind", found_kind);
  return frame;
}

}  // namespace

Result<Octets> write_command(MutableOctets buffer, const DeviceCommand& command) noexcept {
  return write_frame(buffer, Kind::Command,
                     Frame{.mode = static_cast<std::uint8_t>(command.mode),
                           .epoch = command.epoch,
                           .sequence = command.sequence,
                           .flags = 0,
                           .watchdog_us = command.watchdog_us,
                           .payload = command.payload});
}

Result<Octets> write_status(MutableOctets buffer, const DeviceStatus& status) noexcept {
  return write_frame(buffer, Kind::Status,
                     Frame{.mode = 0,
                           .epoch = status.epoch,
                           .sequence = status.sequence,
                           .flags = status.flags,
                           .watchdog_us = 0,
                           .payload = status.payload});
}

Result<DeviceCommand> read_command(Octets frame) noexcept {
  HIROSCO_TRY_LET(const Frame found, read_frame(frame, Kind::Command));
  if (found.mode > static_cast<std::uint8_t>(DeviceMode::Stop))
    return fail(ErrorCode::Malformed, "device command mode", found.mode);
  return DeviceCommand{static_cast<DeviceMode>(found.mode), found.epoch, found.sequence, found.watchdog_us,
                       found.payload};
}

Result<DeviceStatus> read_status(Octets frame) noexcept {
  HIROSCO_TRY_LET(const Frame found, read_frame(frame, Kind::Status));
  return DeviceStatus{found.epoch, found.sequence, found.flags, found.payload};
}

}  // namespace hirosco
