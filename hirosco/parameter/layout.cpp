// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/layout.hpp"

#include <string_view>

namespace hirosco {
namespace {

[[nodiscard]] std::string_view cpp_name(Type type) noexcept {
  switch (type) {
    case Type::Uint8: return "std::uint8_t";
    case Type::Int8: return "std::int8_t";
    case Type::Uint16: return "std::uint16_t";
    case Type::Int16: return "std::int16_t";
    case Type::Uint32: return "std::uint32_t";
    case Type::Int32: return "std::int32_t";
    case Type::Uint64: return "std::uint64_t";
    case Type::Int64: return "std::int64_t";
    case Type::Float: return "float";
    case Type::Double: return "double";
    case Type::Struct: return "struct";
  }
  return "?";
}

}  // namespace

std::string cpp_text(Type type, std::uint16_t count) {
  std::string text{cpp_name(type)};
  return count == 1 ? text : "std::array<" + text + ", " + std::to_string(count) + ">";
}

std::string descriptor_text(Type type, std::uint16_t count) {
  std::string text{to_text(type)};
  return count == 1 ? text : text + "[" + std::to_string(count) + "]";
}

}  // namespace hirosco
