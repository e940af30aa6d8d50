// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// CCSDS unsegmented time code (CCSDS 301.0-B-4). On our links always 4 octets of seconds and 3 of fraction without
/// P-field, epoch 1958-01-01 TAI (docs/interfaces/packets.md).
namespace hirosco::pus {

inline constexpr std::size_t cuc_octets = 7;
using Cuc = std::array<std::byte, cuc_octets>;

/// Truncates to 2^-24 s. Times before the epoch become 0, times after 2094 the greatest code.
/// Realtime: wait-free. Thread: any.
[[nodiscard]] Cuc to_cuc(OnboardTime time) noexcept;
/// The first nanosecond that has this code, so that encoding it again gives the same octets.
/// `code` has at least 7 octets.  Realtime: wait-free.
[[nodiscard]] OnboardTime from_cuc(Octets code) noexcept;

/// Relative time: two's complement over all 56 bits, unit 2^-24 s; rounds down, saturates at about 68 years.
[[nodiscard]] Cuc to_relative_cuc(Duration span) noexcept;
[[nodiscard]] Duration from_relative_cuc(Octets code) noexcept;

/// Any form of the code, for what other systems send.
struct CucFormat {
  std::uint8_t coarse_octets{4};     ///< 1 .. 7
  std::uint8_t fine_octets{3};       ///< 0 .. 4
  bool p_field{false};               ///< the preamble stands before the code
  bool agency_epoch{false};          ///< the time counts from an epoch of the agency, not from 1958
  friend bool operator==(const CucFormat&, const CucFormat&) = default;
};
struct CucTime {
  OnboardTime time{};                ///< since the epoch of `format`
  CucFormat format;
};

/// InvalidArgument: format outside its ranges; OutOfRange: time not representable; ResourceExhausted: buffer too small.
[[nodiscard]] Result<std::size_t> write_cuc(MutableOctets to, const CucTime& time) noexcept;
/// Reads a code that begins with its P-field and fills `octets` exactly. Malformed otherwise.
[[nodiscard]] Result<CucTime> read_cuc(Octets octets) noexcept;
/// Reads a code of a known form. Malformed: the wrong length; InvalidArgument: the form says there is a P-field.
[[nodiscard]] Result<OnboardTime> read_cuc(Octets octets, const CucFormat& format) noexcept;

}  // namespace hirosco::pus
