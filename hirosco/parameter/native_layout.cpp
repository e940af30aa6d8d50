// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/native_layout.hpp"

#include <algorithm>
#include <cstring>
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
    case Type::Bool: return "bool";
    case Type::Text: return "Text";
  }
  return "?";
}

}  // namespace

bool ObjectFields::set_length(std::size_t field, std::uint32_t count, MutableOctets object) noexcept {
  if (field >= own_.size() || own_[field].most == 0) return false;
  own_[field].count = std::min<std::uint32_t>(count, own_[field].most);
  fit(object);
  return true;
}

void ObjectFields::fit(MutableOctets object) const noexcept {
  for (const NativeField& field : own_) {
    if (field.most == 0) continue;
    const std::size_t beyond = octets_of(field.type) * (field.most - field.count);
    std::memset(object.data() + field.offset + field.octets(), 0, beyond);
    const auto length = static_cast<std::uint16_t>(field.count);  // at most `most`
    std::memcpy(object.data() + field.length_offset, &length, sizeof length);
  }
}

std::string cpp_text(const NativeField& field) {
  const std::string text{cpp_name(field.type)};
  if (field.type == Type::Text) return text + "<" + std::to_string(field.count) + ">";
  if (field.most != 0) return "Sized<" + text + ", " + std::to_string(field.most) + ">";
  return field.count == 1 ? text : "std::array<" + text + ", " + std::to_string(field.count) + ">";
}

std::string descriptor_text(Type type, std::uint32_t count) {
  std::string text{to_text(type)};
  if (type == Type::Text) return text + " of " + std::to_string(count) + " octets";
  return count == 1 ? text : text + "[" + std::to_string(count) + "]";
}

}  // namespace hirosco
