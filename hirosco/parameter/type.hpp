// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/enum_text.hpp"

namespace hirosco {

/// Types a parameter, link field, device field or function argument may have. The value is the layout code of the
/// parameter id on the wire (docs/adr/0003).
enum class Type : std::uint8_t {
  Uint8 = 1,
  Int8 = 2,
  Uint16 = 3,
  Int16 = 4,
  Uint32 = 5,
  Int32 = 6,
  Uint64 = 7,
  Int64 = 8,
  Float = 9,
  Double = 10,
  Struct = 32,
  Bool = 33,  ///< one octet, 0 or 1; of a function's argument only
  Text = 34,  ///< UTF-8 up to a declared length; of a function's argument only
};

template <>
struct EnumTexts<Type> {
  static constexpr auto table = enum_table<Type>({
      {Type::Uint8, "UINT8"},
      {Type::Int8, "INT8"},
      {Type::Uint16, "UINT16"},
      {Type::Int16, "INT16"},
      {Type::Uint32, "UINT32"},
      {Type::Int32, "INT32"},
      {Type::Uint64, "UINT64"},
      {Type::Int64, "INT64"},
      {Type::Float, "FLOAT"},
      {Type::Double, "DOUBLE"},
      {Type::Struct, "STRUCT"},
      {Type::Bool, "BOOL"},
      {Type::Text, "TEXT"},
  });
};

/// Octets of one value of a type; 0 for a structure, whose size is that of its members, and for text.
[[nodiscard]] constexpr std::size_t octets_of(Type type) noexcept {
  switch (type) {
    case Type::Uint8:
    case Type::Int8:
    case Type::Bool: return 1;
    case Type::Uint16:
    case Type::Int16: return 2;
    case Type::Uint32:
    case Type::Int32:
    case Type::Float: return 4;
    case Type::Uint64:
    case Type::Int64:
    case Type::Double: return 8;
    case Type::Struct:
    case Type::Text: return 0;
  }
  return 0;
}

[[nodiscard]] constexpr bool is_integer(Type type) noexcept {
  return (type >= Type::Uint8 && type <= Type::Int64) || type == Type::Bool;
}

/// A parameter's identity: subsystem, layout and id (paper 4.1). On the wire one u32 in this order.
struct ParameterId {
  std::uint16_t subsystem{};
  Type layout{Type::Struct};
  std::uint8_t id{};
  [[nodiscard]] constexpr std::uint32_t wire() const noexcept {
    return static_cast<std::uint32_t>(subsystem) << 16 | static_cast<std::uint32_t>(layout) << 8 | id;
  }
  friend constexpr bool operator==(const ParameterId&, const ParameterId&) = default;
};

}  // namespace hirosco
