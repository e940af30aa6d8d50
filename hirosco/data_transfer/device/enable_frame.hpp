// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The second inhibit of an actuator: what the supervisor's side and a device say to each other on an endnode that no
/// subsystem ever holds. The payload of the subsystem's frames reaches the motors only while an enable command that is
/// younger than its limit says so and names the epoch of those frames; otherwise the device does its declared stop by
/// itself. It answers every enable command, whatever the subsystem does.
/// Little endian:  magic u16 | kind u8 | enabled or output u8 | flags u16 | epoch u32 | sequence u32 |
/// CRC-16/CCITT-FALSE u16 over all before. Every frame has the same length, in each version; the kinds are those of this one.
namespace hirosco {

inline constexpr std::uint16_t enable_frame_magic = 0x4845;  ///< "EH" in memory, 'HE' as a number
inline constexpr std::size_t enable_frame_octets = 16;

/// An older enable command counts as withdrawn.
inline constexpr Duration enable_limit = std::chrono::milliseconds{50};
inline constexpr Duration enable_limit_reduced = std::chrono::milliseconds{100};  ///< without real-time scheduling

/// What a device does with its actuators, as it says itself.
enum class DeviceOutput : std::uint8_t {
  Off = 0,  ///< no torque
  Active = 1,  ///< what the subsystem commands
  Stopping = 2,  ///< the declared stop is under way
  Holding = 3,  ///< the declared stop has ended: at rest and held by brake or drives
};

struct EnableCommand {
  std::uint8_t enabled{0};  ///< 0 or 1
  std::uint32_t epoch{0};  ///< of the subsystem's frames that are let through
  std::uint32_t sequence{0};  ///< counts commands, wraps
};

struct EnableStatus {
  DeviceOutput output{DeviceOutput::Off};
  std::uint16_t flags{0};  ///< device_flag
  std::uint32_t epoch{0};  ///< highest that was accepted from the subsystem
  std::uint32_t sequence{0};  ///< of the enable command that this answers
};

/// Writes one frame into `buffer` and returns the part that was filled. ResourceExhausted: buffer too small.
/// Realtime: bounded, no allocation. Thread: any.
[[nodiscard]] Result<Octets> write_enable_command(MutableOctets buffer, const EnableCommand& command) noexcept;
[[nodiscard]] Result<Octets> write_enable_status(MutableOctets buffer, const EnableStatus& status) noexcept;

/// Reads exactly one frame. Malformed: length, magic, CRC, kind, or a value that does not exist; `value` tells the number.
/// Mismatch: it is intact and of another version; `value` is its kind.
/// Realtime: bounded, no allocation. Thread: any.
[[nodiscard]] Result<EnableCommand> read_enable_command(Octets frame) noexcept;
[[nodiscard]] Result<EnableStatus> read_enable_status(Octets frame) noexcept;

}  // namespace hirosco
