// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/subsystem.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

/// The arguments of a function as its descriptor types them (adr 0063): what is permitted, how a value stands on the wire,
/// in a call on its way to the cycle, and in words. All who meet a function read it here.
namespace hirosco::pus {

using Argument = descriptor::Function::Argument;

/// Values of an argument: the elements of an array, one for anything else.
[[nodiscard]] inline std::size_t value_count(const Argument& argument) noexcept {
  return argument.field.type == Type::Text ? 1 : argument.field.count;
}
[[nodiscard]] std::size_t value_count(const descriptor::Function& function) noexcept;

/// Finite, in the declared range, a value of the enumeration.  Realtime: bounded.
[[nodiscard]] bool permits(const Argument& argument, const Number& number) noexcept;
/// Valid UTF-8 without NUL, and no longer than declared.  Realtime: bounded.
[[nodiscard]] bool permits(const Argument& argument, std::string_view text) noexcept;

/// Appends one value as it stands on the wire: a number big-endian in its type, text as its length (u16) and its octets.
/// InvalidArgument: a number where words are wanted or the other way round, a fraction for an integer, not a number, no
/// UTF-8; OutOfRange: against the declared range, length or type.
[[nodiscard]] Result<> append_value(std::vector<std::byte>& data, const Argument& argument, const Value& value);

/// The arguments of one call, each at its place in declared order: trivially copyable.
using ArgumentData = std::array<std::byte, descriptor::max_argument_octets>;

/// Reads them one value after the other, as the function declares them.  Realtime: bounded, no allocation.
class ArgumentReader {
 public:
  ArgumentReader(std::span<const Argument> declared, Octets data) noexcept : declared_{declared}, reader_{data} {}
  /// Of the argument that is next.
  [[nodiscard]] std::uint16_t count() const noexcept {
    return next_ < declared_.size() ? declared_[next_].field.count : std::uint16_t{0};
  }
  /// Values of all that is left.
  [[nodiscard]] std::size_t remaining() const noexcept;
  /// The next number; 0 when there is none.
  [[nodiscard]] Number number() noexcept;
  /// The next words; they lie in the data.
  [[nodiscard]] std::string_view text() noexcept;
  /// All that is left, for words and clients.
  [[nodiscard]] std::vector<Value> rest();

 private:
  std::span<const Argument> declared_;
  OctetReader reader_;
  std::size_t next_{0};
  std::uint16_t element_{0};
};

/// What somebody typed: a number, the name of a value, or words. Empty: it is none of these.
[[nodiscard]] std::optional<Value> parse_value(const Argument& argument, std::string_view text);
/// The name of a value, else all its digits; words in quotes, without what steers a terminal.
[[nodiscard]] std::string value_text(const Argument& argument, const Value& value);
/// "UINT64, 1 to 5 m", "red, green", "text of at most 20 octets": what it may be.
[[nodiscard]] std::string range_text(const Argument& argument);

}  // namespace hirosco::pus
