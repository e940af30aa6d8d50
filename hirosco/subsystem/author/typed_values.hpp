// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/pus/service/arguments.hpp"

/// The C++ types of what a descriptor declares as typed values: arguments of functions, of requests to others and to own
/// services, and fields of their reports. One table for all of them (adr 0063).
namespace hirosco {
namespace detail {

template <class T>
struct IsSized : std::false_type {};
template <class T, std::size_t N>
struct IsSized<Sized<T, N>> : std::true_type {};

template <class T>
concept ArgumentNumber = std::is_same_v<T, bool> || layout_detail::Scalar<T>;
template <class T>
concept ArgumentType =
    std::is_same_v<T, std::string_view> || ArgumentNumber<typename layout_detail::ArrayOf<T>::Element>;

/// The C++ type of a handler's argument, as it is compared with the descriptor.
template <ArgumentType T>
[[nodiscard]] constexpr NativeField native_argument() noexcept {
  using Element = typename layout_detail::ArrayOf<T>::Element;
  NativeField native;
  if constexpr (std::is_same_v<T, std::string_view>) native.type = Type::Text;
  else if constexpr (std::is_same_v<Element, bool>) native.type = Type::Bool;
  else native.type = layout_detail::type_of<Element>();
  native.count = layout_detail::ArrayOf<T>::count;
  if constexpr (IsSized<T>::value) native.most = layout_detail::ArrayOf<T>::most;
  return native;
}

/// Exact: what `T` does not have was refused before.
template <ArgumentNumber T>
[[nodiscard]] constexpr T number_as(const Number& number) noexcept {
  if constexpr (std::is_enum_v<T>) return static_cast<T>(number_as<std::underlying_type_t<T>>(number));
  else if constexpr (std::is_floating_point_v<T>) return static_cast<T>(number.real());
  else return number.as<T>().value_or(T{});
}

template <ArgumentType T>
[[nodiscard]] T take(pus::ArgumentReader& reader) noexcept {
  if constexpr (std::is_same_v<T, std::string_view>) return reader.text();
  else if constexpr (layout_detail::ArrayOf<T>::value) {
    T values{};
    if constexpr (IsSized<T>::value) values = T::zeros(reader.count());
    for (auto& value : values) value = number_as<typename layout_detail::ArrayOf<T>::Element>(reader.number());
    return values;
  } else {
    return number_as<T>(reader.number());
  }
}

/// What may be sent.
template <class T>
concept SentType = ArgumentType<T> && !IsSized<T>::value;

template <SentType T>
[[nodiscard]] pus::ValueView view_of(const void* at, [[maybe_unused]] std::size_t element) noexcept {
  using Element = typename layout_detail::ArrayOf<T>::Element;
  const T& value = *static_cast<const T*>(at);
  if constexpr (std::is_same_v<T, std::string_view>) return value;
  else if constexpr (layout_detail::ArrayOf<T>::value) return view_of<Element>(&value[element], 0);
  else if constexpr (std::is_enum_v<T>) return Number{static_cast<std::underlying_type_t<T>>(value)};
  else return Number{value};
}
/// As encoders take them, exactly, while the values are there: nothing is copied, nor taken from the heap.
template <SentType... T>
[[nodiscard]] std::array<pus::NativeValue, sizeof...(T)> views_of(const T&... values) noexcept {
  std::array<pus::NativeValue, sizeof...(T)> all{
      pus::NativeValue{&values, layout_detail::ArrayOf<T>::count, view_of<T>}...};
  return all;
}

}  // namespace detail

/// What keeps a handler of these C++ types from being called with all that is declared, each mistake behind `who`; `takes`:
/// nothing when it takes FunctionValues.
[[nodiscard]] std::vector<std::string> handler_mistakes(const std::string& who,
                                                        std::optional<std::span<const NativeField>> takes,
                                                        pus::ArgumentList declared);
/// Whether what is sent has the declared types.
[[nodiscard]] bool same_types(std::span<const NativeField> native, pus::ArgumentList declared) noexcept;
/// "double, std::array<bool, 2>", "DOUBLE, TEXT of 9 octets"; "nothing".
[[nodiscard]] std::string types_text(std::span<const NativeField> native);
[[nodiscard]] std::string types_text(pus::ArgumentList declared);

}  // namespace hirosco
