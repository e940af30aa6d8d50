// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco {

/// A number of any type of the descriptor, exactly: from -2^63 to 2^64-1 no integer loses a digit, and it is compared
/// with doubles without rounding either.
class Number {
 public:
  constexpr Number() noexcept = default;
  template <class T>
    requires std::is_arithmetic_v<T>
  constexpr Number(T value) noexcept {  // NOLINT: every number is one
    if constexpr (std::is_floating_point_v<T>) take_real(static_cast<double>(value));
    else take_whole(value);
  }

  [[nodiscard]] constexpr bool is_whole() const noexcept { return kind_ != Kind::Real; }
  [[nodiscard]] bool is_finite() const noexcept { return is_whole() || std::isfinite(real_); }
  /// The nearest double.
  [[nodiscard]] constexpr double real() const noexcept {
    if (kind_ == Kind::Real) return real_;
    return kind_ == Kind::Negative ? static_cast<double>(negative()) : static_cast<double>(whole_);
  }
  /// As an integer, when `T` has it.
  template <class T>
    requires std::is_integral_v<T>
  [[nodiscard]] constexpr std::optional<T> as() const noexcept {
    if (kind_ == Kind::Real) return real_ == 0.0 ? std::optional{T{0}} : std::nullopt;
    const auto within = [](auto value) -> std::optional<T> {
      if constexpr (std::is_same_v<T, bool>) return value == 0 || value == 1 ? std::optional{value == 1} : std::nullopt;
      else return std::in_range<T>(value) ? std::optional{static_cast<T>(value)} : std::nullopt;
    };
    return kind_ == Kind::Negative ? within(negative()) : within(whole_);
  }

  friend constexpr std::partial_ordering operator<=>(const Number& a, const Number& b) noexcept {
    if (a.kind_ == Kind::Real && b.kind_ == Kind::Real) return a.real_ <=> b.real_;
    if (b.kind_ == Kind::Real) return against(a, b.real_);
    if (a.kind_ == Kind::Real) return 0 <=> against(b, a.real_);
    if (a.kind_ != b.kind_)
      return a.kind_ == Kind::Negative ? std::partial_ordering::less : std::partial_ordering::greater;
    return a.kind_ == Kind::Negative ? a.negative() <=> b.negative() : a.whole_ <=> b.whole_;
  }
  friend constexpr bool operator==(const Number& a, const Number& b) noexcept { return (a <=> b) == 0; }

 private:
  enum class Kind : std::uint8_t { Whole, Negative, Real };
  static constexpr double two_to_63 = 9223372036854775808.0, two_to_64 = 18446744073709551616.0;

  template <class T>
  constexpr void take_whole(T value) noexcept {
    if constexpr (std::is_signed_v<T>)
      if (value < 0) kind_ = Kind::Negative;
    whole_ = static_cast<std::uint64_t>(value);
  }
  /// A whole double is the integer, so that a number has one form. -0.0 is none: its sign reaches the wire.
  constexpr void take_real(double value) noexcept {
    const bool minus_zero = value == 0.0 && std::signbit(value);
    if (!minus_zero && value >= 0.0 && value < two_to_64 && is_integral(value))
      return take_whole(static_cast<std::uint64_t>(value));
    if (value < 0.0 && value >= -two_to_63 && is_integral(value)) return take_whole(static_cast<std::int64_t>(value));
    kind_ = Kind::Real;
    real_ = value;
  }
  /// Of one within the range of 64-bit integers.
  [[nodiscard]] static constexpr bool is_integral(double value) noexcept {
    return value < 0.0 ? static_cast<double>(static_cast<std::int64_t>(value)) == value
                       : static_cast<double>(static_cast<std::uint64_t>(value)) == value;
  }
  [[nodiscard]] constexpr std::int64_t negative() const noexcept { return static_cast<std::int64_t>(whole_); }
  /// An integer against a double that is none, but perhaps -0.0.
  [[nodiscard]] static constexpr std::partial_ordering against(const Number& whole, double real) noexcept {
    if (real != real) return std::partial_ordering::unordered;
    if (real >= two_to_64) return std::partial_ordering::less;
    if (real < -two_to_63) return std::partial_ordering::greater;
    if (real == 0.0) return whole <=> Number{0};
    // A fraction: below 2^53 in magnitude, where the next lower integer is exact.
    const auto truncated = static_cast<std::int64_t>(real);
    const std::int64_t below = real < 0.0 ? truncated - 1 : truncated;
    return whole <= Number{below} ? std::partial_ordering::less : std::partial_ordering::greater;
  }

  Kind kind_{Kind::Whole};
  std::uint64_t whole_{0};  ///< of a negative one: its two's complement
  double real_{0.0};
};

/// Takes the next number of a type; 0 of a structure or text.  Realtime: bounded.
[[nodiscard]] Number read_number(OctetReader& reader, Type type) noexcept;
/// Appends it as `type`, rounded where that is FLOAT or DOUBLE. False, and nothing is written, when the type does not have
/// it.  Realtime: bounded.
[[nodiscard]] bool write_number(OctetWriter& writer, Type type, const Number& number) noexcept;

/// Smallest and largest number of a type.
struct TypeRange {
  Number lowest;
  Number highest;
};
[[nodiscard]] TypeRange range_of(Type type) noexcept;

/// All digits of an integer, the shortest text of a double that reads back the same.
[[nodiscard]] std::string to_string(const Number& number);
/// A finite decimal number and nothing around it; an integer within 64 bits is exact.
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) noexcept;

/// One value as people and clients give it: a number, or words where the type is TEXT.
using Value = std::variant<Number, std::string>;

}  // namespace hirosco
