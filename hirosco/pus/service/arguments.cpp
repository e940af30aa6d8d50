// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st08_function/arguments.hpp"

#include <algorithm>
#include <cstdio>

#include "hirosco/utilities/lower_case.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::pus {
namespace {

[[nodiscard]] Result<> append_number(std::vector<std::byte>& data, const Argument& argument, const Number& number) {
  const descriptor::Field& field = argument.field;
  if (!number.is_finite()) return fail(ErrorCode::InvalidArgument, "argument is not a number");
  if (!permits(argument, number)) return fail(ErrorCode::OutOfRange, "argument outside its range");
  std::array<std::byte, 8> buffer;
  OctetWriter writer{buffer};
  if (!write_number(writer, field.type, number))
    return number.real() != std::trunc(number.real())
               ? fail(ErrorCode::InvalidArgument, "fraction for an integer argument")
               : fail(ErrorCode::OutOfRange, "argument exceeds its type");
  data.insert(data.end(), writer.written().begin(), writer.written().end());
  return ok();
}

[[nodiscard]] Result<> append_text(std::vector<std::byte>& data, const Argument& argument, std::string_view text) {
  if (text.size() > argument.field.text_octets) return fail(ErrorCode::OutOfRange, "text longer than declared");
  if (!permits(argument, text)) return fail(ErrorCode::InvalidArgument, "text is not UTF-8");
  const std::size_t begin = data.size();
  data.resize(begin + sizeof(std::uint16_t) + text.size());
  OctetWriter{std::span{data}.subspan(begin)}
      .put(static_cast<std::uint16_t>(text.size()))
      .put(std::as_bytes(std::span{text}));
  return ok();
}

}  // namespace

std::size_t value_count(const descriptor::Function& function) noexcept {
  std::size_t count = 0;
  for (const Argument& argument : function.arguments) count += value_count(argument);
  return count;
}

bool permits(const Argument& argument, const Number& number) noexcept {
  const descriptor::Field& field = argument.field;
  if (!number.is_finite() || (field.minimum && number < *field.minimum) || (field.maximum && number > *field.maximum))
    return false;
  return argument.texts.empty() ||
         std::ranges::any_of(argument.texts, [&](const auto& text) { return number == Number{text.value}; });
}

bool permits(const Argument& argument, std::string_view text) noexcept {
  return text.size() <= argument.field.text_octets && is_text(text);
}

Result<> append_value(std::vector<std::byte>& data, const Argument& argument, const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  const bool wants_text = argument.field.type == Type::Text;
  if (wants_text && text != nullptr) return append_text(data, argument, *text);
  if (wants_text) return fail(ErrorCode::InvalidArgument, "a number where text is wanted");
  if (text != nullptr) return fail(ErrorCode::InvalidArgument, "text where a number is wanted");
  return append_number(data, argument, std::get<Number>(value));
}

std::size_t ArgumentReader::remaining() const noexcept {
  std::size_t count = 0;
  for (const Argument& argument : declared_.subspan(next_)) count += value_count(argument);
  return count - element_;
}

Number ArgumentReader::number() noexcept {
  if (next_ >= declared_.size() || declared_[next_].field.type == Type::Text) return {};
  const descriptor::Field& field = declared_[next_].field;
  const Number value = read_number(reader_, field.type);
  if (++element_ >= field.count) {
    element_ = 0;
    ++next_;
  }
  return value;
}

std::string_view ArgumentReader::text() noexcept {
  if (next_ >= declared_.size() || declared_[next_].field.type != Type::Text) return {};
  const std::size_t most = declared_[next_++].field.text_octets;
  const std::size_t octets = std::min<std::size_t>(reader_.get<std::uint16_t>(), most);
  const Octets words = reader_.get(octets);
  static_cast<void>(reader_.get(most - octets));
  return {reinterpret_cast<const char*>(words.data()), words.size()};
}

std::vector<Value> ArgumentReader::rest() {
  std::vector<Value> values;
  while (next_ < declared_.size())
    if (declared_[next_].field.type == Type::Text) values.emplace_back(std::string{text()});
    else values.emplace_back(number());
  return values;
}

std::optional<Value> parse_value(const Argument& argument, std::string_view text) {
  if (argument.field.type == Type::Text) return std::string{text};
  if (const auto number = parse_number(text)) return *number;
  const std::string wanted = lower_case(std::string{text});
  for (const auto& named : argument.texts)
    if (lower_case(named.text) == wanted) return Number{named.value};
  return std::nullopt;
}

std::string value_text(const Argument& argument, const Value& value) {
  if (const auto* words = std::get_if<std::string>(&value)) {
    std::string text = "'";
    for (const char c : *words) text += static_cast<unsigned char>(c) < ' ' || c == 0x7F ? '?' : c;
    return text + "'";
  }
  const Number& number = std::get<Number>(value);
  for (const auto& named : argument.texts)
    if (number == Number{named.value}) return named.text;
  if (number.is_whole()) return to_string(number);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", number.real());
  return text.data();
}

std::string range_text(const Argument& argument) {
  const descriptor::Field& field = argument.field;
  if (field.type == Type::Text) return "text of at most " + std::to_string(field.text_octets) + " octets";
  std::string text = field.count == 1 ? "" : std::to_string(field.count) + " of ";
  if (!argument.texts.empty()) {
    std::string names;
    for (const auto& named : argument.texts) names.append(names.empty() ? "" : "|").append(named.text);
    return text + names;
  }
  const TypeRange range = range_of(field.type);
  text.append(to_string(field.minimum.value_or(range.lowest))).append("..");
  text.append(to_string(field.maximum.value_or(range.highest)));
  return field.unit.empty() ? text : text + " " + field.unit;
}

}  // namespace hirosco::pus
