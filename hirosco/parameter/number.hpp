// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/octets.hpp"

/// A typed number on the wire as a double in memory: how laws, limits of devices and displays handle every type alike.
/// 64-bit integers above 2^53 lose their last digits on this way; `exact_number.hpp` has the one on which they do not.
namespace hirosco {

/// Appends `value` as `type`; integers are truncated towards zero and held at the ends of their range, NaN becomes 0.
/// Realtime: bounded.
inline void put_number(OctetWriter& writer, Type type, double value) noexcept {
  const auto held = [value]<class T>(std::type_identity<T>) noexcept -> OnWire<T> {
    constexpr T low = std::numeric_limits<T>::lowest(), high = std::numeric_limits<T>::max();
    if (!(value == value)) return {};
    if (value <= static_cast<double>(low)) return low;
    if (value >= static_cast<double>(high)) return high;
    return static_cast<OnWire<T>>(value);
  };
  static_cast<void>(with_number_type(type, false, [&]<class T>(std::type_identity<T> as) noexcept {
    if constexpr (std::is_floating_point_v<T>) writer.put(static_cast<T>(value));
    else writer.put(held(as));
    return true;
  }));
}

/// Takes the next number of `type`.  Realtime: bounded.
[[nodiscard]] inline double get_number(OctetReader& reader, Type type) noexcept {
  return with_number_type(
      type, 0.0, [&]<class T>(std::type_identity<T>) noexcept { return static_cast<double>(reader.get<OnWire<T>>()); });
}

}  // namespace hirosco
