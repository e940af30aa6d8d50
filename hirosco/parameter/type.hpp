// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

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
  Bool = 33,  ///< one octet, 0 or 1; no real-time link and no device frame carries it, or the next
  Text = 34,  ///< UTF-8 up to a declared number of octets
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

/// What `visit` returns for the std::type_identity of the C++ type of a number, which is bool for BOOL; `none` for a structure
/// and for text. The one place that goes through all types.  Realtime: bounded, as `visit` is.
template <class Result, class Visit>
[[nodiscard]] constexpr Result with_number_type(Type type, Result none, Visit visit) noexcept {
  switch (type) {
    case Type::Bool: return visit(std::type_identity<bool>{});
    case Type::Uint8: return visit(std::type_identity<std::uint8_t>{});
    case Type::Int8: return visit(std::type_identity<std::int8_t>{});
    case Type::Uint16: return visit(std::type_identity<std::uint16_t>{});
    case Type::Int16: return visit(std::type_identity<std::int16_t>{});
    case Type::Uint32: return visit(std::type_identity<std::uint32_t>{});
    case Type::Int32: return visit(std::type_identity<std::int32_t>{});
    case Type::Uint64: return visit(std::type_identity<std::uint64_t>{});
    case Type::Int64: return visit(std::type_identity<std::int64_t>{});
    case Type::Float: return visit(std::type_identity<float>{});
    case Type::Double: return visit(std::type_identity<double>{});
    case Type::Struct:
    case Type::Text: break;
  }
  return none;
}
/// What a switch is called where people read it.
[[nodiscard]] constexpr std::string_view switch_word(bool on) noexcept { return on ? "on" : "off"; }

/// As which such a type stands on the wire.
template <class T>
using OnWire = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;

/// Octets of one element of a type; 0 for a structure, whose size is that of its members. The elements of a text are its octets.
[[nodiscard]] constexpr std::size_t octets_of(Type type) noexcept {
  return with_number_type(type, type == Type::Text ? std::size_t{1} : std::size_t{0},
                          []<class T>(std::type_identity<T>) noexcept { return sizeof(OnWire<T>); });
}

/// Whether a real-time link or a device frame carries it: numbers, which are copied and scattered as they are.
[[nodiscard]] constexpr bool is_carried(Type type) noexcept { return type >= Type::Uint8 && type <= Type::Double; }

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
