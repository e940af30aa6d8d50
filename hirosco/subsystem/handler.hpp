// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "hirosco/parameter/layout.hpp"
#include "hirosco/pus/packet/failure.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st08_function/arguments.hpp"
#include "hirosco/utilities/result.hpp"

/// What a function's handler takes and returns, and how its C++ types are known to the framework.
namespace hirosco {

/// One running execution of a function: kept by an author to report progress and completion later.
struct Call {
  pus::Request request{};
};

/// What a function handler says at once (decision 13).
struct Outcome {
  enum class Kind : std::uint8_t { Done, Running, Refused };
  Kind kind{Kind::Done};
  pus::FailureCode code{};
  Error reason{};  ///< words and number of a refusal; its text may be empty
  constexpr Outcome(Kind what, pus::FailureCode why = {}) noexcept : kind{what}, code{why} {}
  Outcome(const Result<>& result) noexcept;  // NOLINT: a handler may simply return a Result<>
};
inline constexpr Outcome running{Outcome::Kind::Running};

/// An author's own failure codes: `enum class Trouble : std::uint16_t { sensor_broken = 0x8001 };`, each named in the
/// descriptor: `<Failure code="0x8001" name="SENSOR_BROKEN"/>`.
template <class E>
concept FailureEnumeration = std::is_enum_v<E> && std::is_same_v<std::underlying_type_t<E>, std::uint16_t>;

/// `text` is a string literal; it reaches ground with `number`.
template <FailureEnumeration E>
[[nodiscard]] constexpr Outcome refused(E code, const char* text = "", std::int64_t number = 0) noexcept {
  Outcome outcome{Outcome::Kind::Refused, static_cast<pus::FailureCode>(code)};
  outcome.reason = {ErrorCode::NotPermitted, text, number};
  return outcome;
}

/// All numbers of a call in the descriptor's order, arrays element by element, as many as it declares.
inline constexpr std::size_t max_function_arguments = descriptor::max_argument_octets / sizeof(double);
using FunctionValues = Sized<double, max_function_arguments>;

/// Reads the arguments as the descriptor types them and calls the author's handler.
using FunctionHandler = std::function<Outcome(pus::ArgumentReader&, Call)>;

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

template <class T>
struct HandlerTraits;
template <class C, class R, class... A>
struct HandlerTraits<R (C::*)(A...) const> {
  using Answer = R;
  using Types = std::tuple<std::remove_cvref_t<A>...>;
  template <class T>
  static constexpr bool is_an_argument =
      ArgumentType<T> || std::is_same_v<T, Call> || std::is_same_v<T, FunctionValues>;
  static constexpr bool takes_what_a_call_brings = (is_an_argument<std::remove_cvref_t<A>> && ...);
  static constexpr bool takes_string = (std::is_same_v<std::remove_cvref_t<A>, std::string> || ... || false);
  static constexpr bool takes_call = (std::is_same_v<std::remove_cvref_t<A>, Call> || ... || false);
  static constexpr bool takes_values = (std::is_same_v<std::remove_cvref_t<A>, FunctionValues> || ... || false);
  static constexpr std::size_t arguments = sizeof...(A) - (takes_call ? 1 : 0);

  [[nodiscard]] static constexpr auto natives() noexcept {
    return []<std::size_t... I>(std::index_sequence<I...>) {
      return std::array<NativeField, sizeof...(I)>{native_argument<std::tuple_element_t<I, Types>>()...};
    }(std::make_index_sequence<arguments>{});
  }
  template <class H>
  static Outcome invoke(const H& handler, pus::ArgumentReader& reader, const Call& call) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) -> Outcome {
      // Between braces: they are taken in this order.
      const std::tuple<std::tuple_element_t<I, Types>...> values{take<std::tuple_element_t<I, Types>>(reader)...};
      if constexpr (takes_call) return handler(std::get<I>(values)..., call);
      else return handler(std::get<I>(values)...);
    }(std::make_index_sequence<arguments>{});
  }
};
/// Not `mutable`, not overloaded, no template.
template <class H>
concept Handler = requires { typename HandlerTraits<decltype(&H::operator())>::Answer; };
template <class R>
concept Answers = std::is_same_v<R, Result<>> || std::is_same_v<R, Outcome>;

}  // namespace detail
}  // namespace hirosco
