// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/enable_frame.hpp"

#include "hirosco/utilities/crc16.hpp"

namespace hirosco {
namespace {

// Apart in more than one bit from each other and from the kinds of a device frame.
enum class EnableKind : std::uint8_t { Command = 0x33, Status = 0x4C };

[[nodiscard]] bool is_enable_kind(std::uint8_t found) noexcept {
  return found == static_cast<std::uint8_t>(EnableKind::Command) ||
         found == static_cast<std::uint8_t>(EnableKind::Status);
}

struct EnableParts {
  std::uint8_t value{0};
  std::uint16_t flags{0};
  std::uint32_t epoch{0};
  std::uint32_t sequence{0};
};

Result<Octets> write_enable_frame(MutableOctets buffer, EnableKind kind, const EnableParts& frame) noexcept {
  OctetWriter writer{buffer, std::endian::little};
  writer.put(enable_frame_magic).put(static_cast<std::uint8_t>(kind)).put(frame.value).put(frame.flags);
  writer.put(frame.epoch).put(frame.sequence);
  if (!writer.good()) return fail(ErrorCode::ResourceExhausted, "buffer too small for an enable frame");
  writer.put(crc16(writer.written()));
  if (!writer.good()) return fail(ErrorCode::ResourceExhausted, "buffer too small for an enable frame");
  return writer.written();
}

Result<EnableParts> read_enable_frame(Octets octets, EnableKind kind, std::uint8_t highest_value) noexcept {
  if (octets.size() != enable_frame_octets)
    return fail(ErrorCode::Malformed, "enable frame length", static_cast<std::int64_t>(octets.size()));
  OctetReader reader{octets, std::endian::little};
  if (const auto magic = reader.get<std::uint16_t>(); magic != enable_frame_magic)
    return fail(ErrorCode::Malformed, "enable frame magic", magic);
  const auto found_kind = reader.get<std::uint8_t>();
  EnableParts frame;
  frame.value = reader.get<std::uint8_t>();
  frame.flags = reader.get<std::uint16_t>();
  frame.epoch = reader.get<std::uint32_t>();
  frame.sequence = reader.get<std::uint32_t>();
  if (const auto sum = reader.get<std::uint16_t>(); sum != crc16(octets.first(enable_frame_octets - 2)))
    return fail(ErrorCode::Malformed, "enable frame checksum", sum);
  if (!is_enable_kind(found_kind)) return fail(ErrorCode::Mismatch, "enable frame of another version", found_kind);
  if (found_kind != static_cast<std::uint8_t>(kind)) return fail(ErrorCode::Malformed, "enable frame kind", found_kind);
  if (frame.value > highest_value) return fail(ErrorCode::Malformed, "enable frame value", frame.value);
  return frame;
}

}  // namespace

Result<Octets> write_enable_command(MutableOctets buffer, const EnableCommand& command) noexcept {
  return write_enable_frame(buffer, EnableKind::Command, {command.enabled, 0, command.epoch, command.sequence});
}

Result<Octets> write_enable_status(MutableOctets buffer, const EnableStatus& status) noexcept {
  return write_enable_frame(buffer, EnableKind::Status,
                            {static_cast<std::uint8_t>(status.output), status.flags, status.epoch, status.sequence});
}

Result<EnableCommand> read_enable_command(Octets frame) noexcept {
  HIROSCO_TRY_LET(const EnableParts found, read_enable_frame(frame, EnableKind::Command, 1));
  return EnableCommand{found.value, found.epoch, found.sequence};
}

Result<EnableStatus> read_enable_status(Octets frame) noexcept {
  HIROSCO_TRY_LET(const EnableParts found,
                  read_enable_frame(frame, EnableKind::Status, static_cast<std::uint8_t>(DeviceOutput::Holding)));
  return EnableStatus{static_cast<DeviceOutput>(found.value), found.flags, found.epoch, found.sequence};
}

}  // namespace hirosco
