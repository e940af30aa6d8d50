// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

/// Typed values as a descriptor declares them, of functions and of a subsystem's own services (adr 0063): what is permitted,
/// how they stand on the wire and on the way to a handler, and in words. All who meet them read it here.
namespace hirosco::pus {

using Argument = descriptor::Function::Argument;
using ArgumentList = std::span<const Argument>;

/// One value where it lies: words stay with whoever has them.
using ValueView = std::variant<Number, std::string_view>;
[[nodiscard]] ValueView view_of(const Value& value) noexcept;

/// An argument as a call in C++ has it: where it is, how many values it is, and what one of them is. However long it is, nothing is copied.
struct NativeValue {
  const void* at{nullptr};
  std::size_t how_many{0};
  ValueView (*view)(const void* at, std::size_t element) noexcept {nullptr};
};

/// Values in declared order, arrays element by element; where they end or are empty, the declared value is sent. They lie with who
/// gives them: what somebody typed, or what an author's call has, for which nothing is taken from the heap.
class GivenValues {
 public:
  GivenValues() = default;
  template <class List>
    requires std::convertible_to<const List&, std::span<const std::optional<Value>>>
  GivenValues(const List& list) noexcept : typed_{list}, size_{typed_.size()} {}
  template <class List>
    requires std::convertible_to<const List&, std::span<const NativeValue>>
  GivenValues(const List& list) noexcept : native_{list} {
    for (const NativeValue& each : native_) size_ += each.how_many;
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// The one at this place; nothing where it is empty, or behind the last.
  [[nodiscard]] std::optional<ValueView> at(std::size_t place) const noexcept;

 private:
  std::span<const std::optional<Value>> typed_;
  std::span<const NativeValue> native_;
  std::size_t size_{0};
};

/// Values of an argument: the elements of an array, one for anything else.
[[nodiscard]] inline std::size_t value_count(const Argument& argument) noexcept {
  return argument.field.type == Type::Text ? 1 : argument.field.count;
}
[[nodiscard]] std::size_t value_count(ArgumentList declared) noexcept;
[[nodiscard]] inline std::size_t value_count(const descriptor::Function& function) noexcept {
  return value_count(ArgumentList{function.arguments});
}
/// Most octets that they take on the wire, without ids.
[[nodiscard]] std::size_t octets_of(ArgumentList declared) noexcept;

/// Finite, in the declared range, a value of the enumeration.  Realtime: bounded.
[[nodiscard]] bool permits(const Argument& argument, const Number& number) noexcept;
/// Valid UTF-8 without NUL, and no longer than declared.  Realtime: bounded.
[[nodiscard]] bool permits(const Argument& argument, std::string_view text) noexcept;

/// How words stand on the wire.
enum class Words : std::uint8_t {
  Counted,  ///< of an argument, and of a report: their length (u16) and their octets
  Padded,  ///< of a parameter: all that it has, behind its words zeros
};
/// Writes one value as it stands on the wire, a number big-endian in its type. Writers that are full say so by good().
/// InvalidArgument: a number where words are wanted or the other way round, a fraction for an integer, not a number, no
/// UTF-8; OutOfRange: against the declared range, length or type.  Realtime: bounded.
[[nodiscard]] Result<> write_value(OctetWriter& writer, const Argument& argument, const ValueView& value,
                                   Words words = Words::Counted) noexcept;

/// What stands before each of a list.
enum class Ids : std::uint8_t {
  None,  ///< of an own service
  One,  ///< of a function: its place from 1, u8
};
/// Writes a whole list. InvalidArgument: too many values, one missing, and what write_value() says.  Realtime: bounded.
[[nodiscard]] Result<> write_values(OctetWriter& writer, ArgumentList declared, GivenValues values, Ids ids) noexcept;
/// The same of what a subsystem tells: no range binds it, for it is so. InvalidArgument, OutOfRange: its type does not have it.
/// Realtime: bounded.
[[nodiscard]] Result<> write_report(OctetWriter& writer, ArgumentList fields, GivenValues values) noexcept;
/// What was written; OutOfRange: it found no room.
[[nodiscard]] Result<Octets> all_written(const OctetWriter& writer) noexcept;

/// write_value() and write_values() behind what is there, which stays as it was where they fail.
[[nodiscard]] Result<> append_value(std::vector<std::byte>& data, const Argument& argument, const Value& value);
[[nodiscard]] Result<> append_values(std::vector<std::byte>& data, ArgumentList declared, GivenValues values, Ids ids);

/// Takes one argument, whole; false when it is none that is permitted. A reader that is good no more had too few octets.
/// Realtime: bounded.
[[nodiscard]] bool take_permitted(OctetReader& reader, const Argument& argument) noexcept;
/// The first of a list without ids that is not permitted, from 1; 0 when all are. Empty: it is no such list.
[[nodiscard]] std::optional<std::size_t> first_not_permitted(ArgumentList declared, Octets data) noexcept;

/// The arguments of one call in declared order, as a list without ids: trivially copyable.
using ArgumentData = std::array<std::byte, descriptor::max_argument_octets>;

/// Reads such a list one value after the other.  Realtime: bounded, no allocation.
class ArgumentReader {
 public:
  ArgumentReader(ArgumentList declared, Octets data) noexcept : declared_{declared}, reader_{data} {}
  /// False when values were read that the octets did not have.
  [[nodiscard]] bool good() const noexcept { return reader_.good(); }
  /// Of the argument that is next.
  [[nodiscard]] std::uint32_t count() const noexcept {
    return next_ < declared_.size() ? declared_[next_].field.count : std::uint32_t{0};
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
  ArgumentList declared_;
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
