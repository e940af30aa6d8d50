// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

/// What a device and its endnode say to each other over a DataFlow: one frame per cycle each way (decisions 7, 22, 29).
/// Little endian:  magic u16 | kind u8 | mode u8 | epoch u32 | sequence u32 | flags u16 | payload octets u16 |
/// watchdog_us u32 | payload | CRC-16/CCITT-FALSE u16 over all before. The payload holds the endnode's fields packed
/// without padding in the endnode's byte order; this codec does not look inside.
/// The kinds are those of this version: a later one has others, so that who knows this one only refuses it by name.
namespace hirosco {

inline constexpr std::uint16_t device_frame_magic = 0x4844;  ///< "DH" in memory, 'HD' as a number
inline constexpr std::size_t device_frame_header_octets = 20;
inline constexpr std::size_t device_frame_overhead_octets = device_frame_header_octets + 2;
/// What every data flow carries.
inline constexpr std::size_t max_device_frame_octets = max_frame_octets;
inline constexpr std::size_t max_device_payload_octets = max_device_frame_octets - device_frame_overhead_octets;

enum class DeviceMode : std::uint8_t {
  Off = 0,  ///< the device applies its own safe output and ignores the payload
  Active = 1,  ///< the device applies the payload
  Stop = 2,  ///< controlled stop by the device itself, then safe output
};

/// Bits of DeviceStatus::flags.
namespace device_flag {
inline constexpr std::uint16_t watchdog_tripped = 1U << 0;  ///< latched until a command with a higher epoch
inline constexpr std::uint16_t old_epoch_refused = 1U << 1;
inline constexpr std::uint16_t over_temperature = 1U << 2;
inline constexpr std::uint16_t torque_saturated = 1U << 3;
}  // namespace device_flag

struct DeviceCommand {
  DeviceMode mode{DeviceMode::Off};
  std::uint32_t epoch{0};  ///< of the permit page; the device refuses a lower one than it has seen
  std::uint32_t sequence{0};  ///< counts frames, wraps
  std::uint32_t watchdog_us{0};  ///< output off after this time without a valid command; 0 = device default
  Octets payload;  ///< of a read frame: views the frame
};

struct DeviceStatus {
  std::uint32_t epoch{0};  ///< highest that was accepted
  std::uint32_t sequence{0};  ///< of the last accepted command
  std::uint16_t flags{0};
  Octets payload;  ///< of a read frame: views the frame
};

/// Writes one frame into `buffer` and returns the part that was filled. OutOfRange: payload longer than allowed.
/// ResourceExhausted: buffer too small.  Realtime: bounded, no allocation. Thread: any.
[[nodiscard]] Result<Octets> write_command(MutableOctets buffer, const DeviceCommand& command) noexcept;
[[nodiscard]] Result<Octets> write_status(MutableOctets buffer, const DeviceStatus& status) noexcept;

/// Reads exactly one frame. Malformed: length, magic, kind, mode or CRC is wrong; `value` tells the offending number. Mismatch: it is
/// intact and of another version; `value` is its kind.
/// Realtime: bounded, no allocation. Thread: any.
[[nodiscard]] Result<DeviceCommand> read_command(Octets frame) noexcept;
[[nodiscard]] Result<DeviceStatus> read_status(Octets frame) noexcept;

}  // namespace hirosco
