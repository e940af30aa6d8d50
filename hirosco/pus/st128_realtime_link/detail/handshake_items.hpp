// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

/// What the decision of the handshake and its octets have in common.
namespace hirosco::pus::st128::detail {

/// An element of the handshake; the value is Refusal::item.
enum class Item : std::uint8_t { Method = 0, ByteOrder = 1, Kind = 2, Rate = 3, Field = 4, Depth = 5, Wake = 6 };

/// Of one sample: packed, or as C++ lays an aggregate that is lent. What is no link's size is not cut off.
[[nodiscard]] std::size_t sample_octets(const std::vector<OfferedField>& fields, LinkKind kind) noexcept;

}  // namespace hirosco::pus::st128::detail
