// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/exact_number.hpp"

#include <array>
#include <charconv>

namespace hirosco {
namespace {

template <class T>
[[nodiscard]] constexpr TypeRange limits_of() noexcept {
  return {std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max()};
}

template <class T>
[[nodiscard]] bool put_whole(OctetWriter& writer, const Number& number) noexcept {
  const auto value = number.as<T>();
  if (value) writer.put(*value);
  return value.has_value();
}

template <class T>
[[nodiscard]] std::optional<Number> parse_as(std::string_view text) noexcept {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return Number{value};
}

}  // namespace

Number read_number(OctetReader& reader, Type type) noexcept {
  switch (type) {
    case Type::Bool:
    case Type::Uint8: return reader.get<std::uint8_t>();
    case Type::Int8: return reader.get<std::int8_t>();
    case Type::Uint16: return reader.get<std::uint16_t>();
    case Type::Int16: return reader.get<std::int16_t>();
    case Type::Uint32: return reader.get<std::uint32_t>();
    case Type::Int32: return reader.get<std::int32_t>();
    case Type::Uint64: return reader.get<std::uint64_t>();
    case Type::Int64: return reader.get<std::int64_t>();
    case Type::Float: return reader.get<float>();
    case Type::Double: return reader.get<double>();
    case Type::Struct:
    case Type::Text: break;
  }
  return {};
}

bool write_number(OctetWriter& writer, Type type, const Number& number) noexcept {
  switch (type) {
    case Type::Bool:
      if (!number.as<bool>()) return false;
      return put_whole<std::uint8_t>(writer, number);
    case Type::Uint8: return put_whole<std::uint8_t>(writer, number);
    case Type::Int8: return put_whole<std::int8_t>(writer, number);
    case Type::Uint16: return put_whole<std::uint16_t>(writer, number);
    case Type::Int16: return put_whole<std::int16_t>(writer, number);
    case Type::Uint32: return put_whole<std::uint32_t>(writer, number);
    case Type::Int32: return put_whole<std::int32_t>(writer, number);
    case Type::Uint64: return put_whole<std::uint64_t>(writer, number);
    case Type::Int64: return put_whole<std::int64_t>(writer, number);
    case Type::Float: {
      const auto rounded = static_cast<float>(number.real());
      if (std::isfinite(number.real()) && !std::isfinite(rounded)) return false;
      writer.put(rounded);
      return true;
    }
    case Type::Double: writer.put(number.real()); return true;
    case Type::Struct:
    case Type::Text: break;
  }
  return false;
}

TypeRange range_of(Type type) noexcept {
  switch (type) {
    case Type::Bool: return {0, 1};
    case Type::Uint8: return limits_of<std::uint8_t>();
    case Type::Int8: return limits_of<std::int8_t>();
    case Type::Uint16: return limits_of<std::uint16_t>();
    case Type::Int16: return limits_of<std::int16_t>();
    case Type::Uint32: return limits_of<std::uint32_t>();
    case Type::Int32: return limits_of<std::int32_t>();
    case Type::Uint64: return limits_of<std::uint64_t>();
    case Type::Int64: return limits_of<std::int64_t>();
    case Type::Float: return limits_of<float>();
    case Type::Double: return limits_of<double>();
    case Type::Struct:
    case Type::Text: break;
  }
  return {};
}

std::string to_string(const Number& number) {
  if (const auto whole = number.as<std::uint64_t>(); whole && number.is_whole()) return std::to_string(*whole);
  if (number.is_whole()) return std::to_string(number.as<std::int64_t>().value_or(0));
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number.real()).ptr;
  return {text.data(), end};
}

std::optional<Number> parse_number(std::string_view text) noexcept {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  if (const auto whole = parse_as<std::uint64_t>(text)) return whole;
  if (const auto negative = parse_as<std::int64_t>(text); negative && text != "-0") return negative;
  const auto real = parse_as<double>(text);
  if (!real || !real->is_finite()) return std::nullopt;
  // Just below -2^63 a double would round into the range that it is outside of.
  const bool digits = text.find_first_not_of("-0123456789") == std::string_view::npos;
  constexpr double least = std::numeric_limits<std::int64_t>::min();
  if (digits && *real == Number{least}) return Number{std::nextafter(least, -std::numeric_limits<double>::infinity())};
  return real;
}

}  // namespace hirosco
