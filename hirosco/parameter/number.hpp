// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/octets.hpp"

/// A typed number on the wire as a double in memory: how laws, limits of devices and displays handle every type alike.
/// 64-bit integers above 2^53 lose their last digits on this way; `exact_number.hpp` has the one on which they do not.
namespace hirosco {

/// Appends `value` as `type`; integers are truncated towards zero and held at the ends of their range, NaN becomes 0.
/// Realtime: bounded.
inline void put_number(OctetWriter& writer, Type type, double value) noexcept {
  const auto integer = [&]<class T>(T low, T high) {
    if (!(value == value)) return T{0};
    if (value <= static_cast<double>(low)) return low;
    if (value >= static_cast<double>(high)) return high;
    return static_cast<T>(value);
  };
  switch (type) {
    case Type::Bool: writer.put(integer(std::uint8_t{0}, std::uint8_t{1})); break;
    case Type::Uint8: writer.put(integer(std::uint8_t{0}, std::uint8_t{UINT8_MAX})); break;
    case Type::Int8: writer.put(integer(std::int8_t{INT8_MIN}, std::int8_t{INT8_MAX})); break;
    case Type::Uint16: writer.put(integer(std::uint16_t{0}, std::uint16_t{UINT16_MAX})); break;
    case Type::Int16: writer.put(integer(std::int16_t{INT16_MIN}, std::int16_t{INT16_MAX})); break;
    case Type::Uint32: writer.put(integer(std::uint32_t{0}, std::uint32_t{UINT32_MAX})); break;
    case Type::Int32: writer.put(integer(std::int32_t{INT32_MIN}, std::int32_t{INT32_MAX})); break;
    case Type::Uint64: writer.put(integer(std::uint64_t{0}, std::uint64_t{UINT64_MAX})); break;
    case Type::Int64: writer.put(integer(std::int64_t{INT64_MIN}, std::int64_t{INT64_MAX})); break;
    case Type::Float: writer.put(static_cast<float>(value)); break;
    case Type::Double: writer.put(value); break;
    case Type::Struct:
    case Type::Text: break;
  }
}

/// Takes the next number of `type`.  Realtime: bounded.
[[nodiscard]] inline double get_number(OctetReader& reader, Type type) noexcept {
  switch (type) {
    case Type::Bool:
    case Type::Uint8: return reader.get<std::uint8_t>();
    case Type::Int8: return reader.get<std::int8_t>();
    case Type::Uint16: return reader.get<std::uint16_t>();
    case Type::Int16: return reader.get<std::int16_t>();
    case Type::Uint32: return reader.get<std::uint32_t>();
    case Type::Int32: return reader.get<std::int32_t>();
    case Type::Uint64: return static_cast<double>(reader.get<std::uint64_t>());
    case Type::Int64: return static_cast<double>(reader.get<std::int64_t>());
    case Type::Float: return static_cast<double>(reader.get<float>());
    case Type::Double: return reader.get<double>();
    case Type::Struct:
    case Type::Text: return 0.0;
  }
  return 0.0;
}

}  // namespace hirosco
