// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The persistent values of one subsystem as they stand on a disk (docs/adr/0087). Plain octets: who reads and writes them is elsewhere.
namespace hirosco::supervisor {

/// One whole copy.
struct ValueCopy {
  std::uint64_t layout{};  ///< hash of what the values are: of another layout they mean nothing
  std::uint64_t sequence{};  ///< of the newest change that it has; the higher of two copies is the newer
  OnboardTime since{};  ///< of that change
  std::vector<std::byte> values;
  friend bool operator==(const ValueCopy&, const ValueCopy&) = default;
};

/// Why a copy is not used.
enum class CopyFault : std::uint8_t {
  Missing = 1,  ///< there is none, though there is the other
  Unreadable = 2,  ///< the disk does not give it
  Damaged = 3,  ///< its form or its check sum
  Version = 4,  ///< it was written by another version of hirosco
  Layout = 5,  ///< the descriptor has other persistent parameters since
  Range = 6,  ///< a value is outside the range that the descriptor has since
};

inline constexpr std::uint16_t value_copy_version = 1;
/// Before and behind the values.
inline constexpr std::size_t value_copy_overhead = 4 + 2 + 8 + 8 + 8 + 4 + 4;

[[nodiscard]] std::vector<std::byte> write_copy(const ValueCopy& copy);
/// Anything but exactly what write_copy() gives is a fault: Damaged or Version.
[[nodiscard]] std::expected<ValueCopy, CopyFault> read_copy(Octets octets);

}  // namespace hirosco::supervisor

namespace hirosco {
template <>
struct EnumTexts<supervisor::CopyFault> {
  using enum supervisor::CopyFault;
  static constexpr auto table = enum_table<supervisor::CopyFault>({{Missing, "missing"},
                                                                   {Unreadable, "unreadable"},
                                                                   {Damaged, "damaged"},
                                                                   {Version, "of another version"},
                                                                   {Layout, "of another layout"},
                                                                   {Range, "outside the range"}});
};
}  // namespace hirosco
