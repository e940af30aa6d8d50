// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/exact_number.hpp"

#include <array>
#include <charconv>

namespace hirosco {
namespace {

template <class T>
[[nodiscard]] std::optional<Number> parse_as(std::string_view text) noexcept {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return Number{value};
}

}  // namespace

Number read_number(OctetReader& reader, Type type) noexcept {
  return with_number_type(type, Number{},
                          [&]<class T>(std::type_identity<T>) noexcept { return Number{reader.get<OnWire<T>>()}; });
}

bool write_number(OctetWriter& writer, Type type, const Number& number) noexcept {
  return with_number_type(type, false, [&]<class T>(std::type_identity<T>) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
      const auto rounded = static_cast<T>(number.real());
      if (std::isfinite(number.real()) && !std::isfinite(rounded)) return false;
      writer.put(rounded);
      return true;
    } else {
      const auto value = number.as<T>();
      if (value) writer.put(static_cast<OnWire<T>>(*value));
      return value.has_value();
    }
  });
}

TypeRange range_of(Type type) noexcept {
  return with_number_type(type, TypeRange{}, []<class T>(std::type_identity<T>) noexcept {
    return TypeRange{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max()};
  });
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
