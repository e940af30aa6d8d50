// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/service/arguments.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/subsystem/author/typed_values.hpp"
#include "hirosco/utilities/result.hpp"

/// What the handler of a function, or of a request to an own service, takes and returns.
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
/// A handler as it is bound: what it takes is compared with what is declared.
struct BoundHandler {
  std::optional<std::span<const NativeField>> takes;  ///< nothing: all numbers, whatever is declared
  FunctionHandler call;
};

namespace detail {

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
  /// What a call brings is gone with it: a handler gets it as a value, or looks at it.
  template <class T>
  static constexpr bool is_by_value = !std::is_reference_v<T> || std::is_same_v<T, const std::remove_cvref_t<T>&>;
  static constexpr bool takes_by_value = (is_by_value<A> && ...);
  static constexpr std::size_t calls = (std::size_t{std::is_same_v<std::remove_cvref_t<A>, Call>} + ... + 0);
  static constexpr bool call_comes_last = [] {
    if constexpr (calls == 0) return true;
    else return calls == 1 && std::is_same_v<std::tuple_element_t<sizeof...(A) - 1, Types>, Call>;
  }();
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
template <class C, class R, class... A>
struct HandlerTraits<R (C::*)(A...) const noexcept> : HandlerTraits<R (C::*)(A...) const> {};
/// Not `mutable`, not overloaded, no template.
template <class H>
concept Handler = requires { typename HandlerTraits<decltype(&H::operator())>::Answer; };
template <class R>
concept Answers = std::is_same_v<R, Result<>> || std::is_same_v<R, Outcome>;

template <class H>
[[nodiscard]] BoundHandler bound(H handler) {
  static_assert(Handler<H>, "a handler is a lambda with arguments of definite types, and not mutable");
  using Traits = HandlerTraits<decltype(&H::operator())>;
  static_assert(Answers<typename Traits::Answer>,
                "a handler returns Result<> or Outcome: write '-> Result<>' and end with 'return ok();'");
  static_assert(!Traits::takes_string, "text comes as std::string_view; a std::string would allocate");
  static_assert(Traits::takes_what_a_call_brings,
                "a handler takes numbers or enumerations, bool, std::array or Sized of those, std::string_view for "
                "text, or FunctionValues, and last a Call if it reports later");
  static_assert(Traits::takes_by_value,
                "a handler takes its arguments by value or as const&: there is nobody to whom it could give them back");
  static_assert(Traits::call_comes_last, "a handler takes one Call at most, behind all arguments");
  if constexpr (Traits::takes_values) {
    static_assert(Traits::arguments == 1, "FunctionValues are all numbers of a call; beside them there is a Call only");
    return {std::nullopt, [handler](pus::ArgumentReader& reader, Call call) -> Outcome {
              auto values = FunctionValues::zeros(reader.remaining());
              for (double& value : values) value = reader.number().real();
              if constexpr (Traits::takes_call) return handler(values, call);
              else return handler(values);
            }};
  } else {
    static constexpr auto natives = Traits::natives();
    return {natives, [handler](pus::ArgumentReader& reader, Call call) -> Outcome {
              return Traits::invoke(handler, reader, call);
            }};
  }
}

}  // namespace detail
}  // namespace hirosco
