// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The power switch of a device: what the supervisor's side and the switch say to each other on an endnode that no subsystem ever
/// holds (adr 0079). The switch is on while the newest command says so and is younger than the time that it names; it answers
/// every command. It has power of its own.
/// Little endian:  magic u16 | kind u8 | on u8 | off after u16, ms | sequence u32 | CRC-16/CCITT-FALSE u16 over all before.
/// Every frame has the same length, in each version, and the kinds are those of this one; an answer has 0 for the time.
namespace hirosco {

inline constexpr std::uint16_t power_frame_magic = 0x4850;  ///< "PH" in memory, 'HP' as a number
inline constexpr std::size_t power_frame_octets = 12;

/// A switch that hears nothing for so long is off: longer than a supervisor takes to start again.
inline constexpr Duration power_limit = std::chrono::seconds{2};

struct PowerCommand {
  bool on{false};
  Duration off_after{power_limit};  ///< whole ms, up to 65 s
  std::uint32_t sequence{0};  ///< counts commands, wraps
};

struct PowerStatus {
  bool on{false};
  std::uint32_t sequence{0};  ///< of the command that this answers
};

/// Writes one frame into `buffer` and returns the part that was filled. ResourceExhausted: buffer too small. OutOfRange: a time
/// of more than 65535 ms, or none.  Realtime: bounded, no allocation. Thread: any.
[[nodiscard]] Result<Octets> write_power_command(MutableOctets buffer, const PowerCommand& command) noexcept;
[[nodiscard]] Result<Octets> write_power_status(MutableOctets buffer, const PowerStatus& status) noexcept;

/// Reads exactly one frame. Malformed: length, magic, CRC, kind, or a value that does not exist; `value` tells the number.
/// Mismatch: it is intact and of another version; `value` is its kind.
/// Realtime: bounded, no allocation. Thread: any.
[[nodiscard]] Result<PowerCommand> read_power_command(Octets frame) noexcept;
[[nodiscard]] Result<PowerStatus> read_power_status(Octets frame) noexcept;

}  // namespace hirosco
