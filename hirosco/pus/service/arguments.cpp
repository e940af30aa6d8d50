// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/service/arguments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::pus {
namespace {

/// Of a number of the type, whether it is permitted or not.
[[nodiscard]] Result<> put_number(OctetWriter& writer, const descriptor::Field& field, const Number& number) noexcept {
  if (write_number(writer, field.type, number)) return ok();
  return number.real() != std::trunc(number.real())
             ? fail(ErrorCode::InvalidArgument, "fraction for an integer argument")
             : fail(ErrorCode::OutOfRange, "argument exceeds its type");
}

[[nodiscard]] Result<> put_text(OctetWriter& writer, const descriptor::Field& field, std::string_view text,
                                Words words) noexcept {
  if (text.size() > field.text_octets) return fail(ErrorCode::OutOfRange, "text longer than declared");
  if (!is_text(text)) return fail(ErrorCode::InvalidArgument, "text is not UTF-8");
  if (words == Words::Counted) writer.put(static_cast<std::uint16_t>(text.size()));
  writer.put(std::as_bytes(std::span{text}));
  if (words == Words::Padded) writer.fill(field.text_octets - text.size(), std::byte{});
  return ok();
}

/// One value that the type has.
[[nodiscard]] Result<> put_any(OctetWriter& writer, const descriptor::Field& field, const ValueView& value,
                               Words words) noexcept {
  const auto* text = std::get_if<std::string_view>(&value);
  const bool wants_text = field.type == Type::Text;
  if (wants_text && text != nullptr) return put_text(writer, field, *text, words);
  if (wants_text) return fail(ErrorCode::InvalidArgument, "a number where text is wanted");
  if (text != nullptr) return fail(ErrorCode::InvalidArgument, "text where a number is wanted");
  return put_number(writer, field, std::get<Number>(value));
}

/// What `write` writes, behind what is there.
template <class Write>
[[nodiscard]] Result<> append_written(std::vector<std::byte>& data, const Write& write) {
  std::array<std::byte, max_telecommand_octets> room;
  OctetWriter writer{room};
  HIROSCO_TRY(write(writer));
  HIROSCO_TRY_LET(const Octets written, all_written(writer));
  data.insert(data.end(), written.begin(), written.end());
  return ok();
}

}  // namespace

ValueView view_of(const Value& value) noexcept {
  if (const auto* words = std::get_if<std::string>(&value)) return std::string_view{*words};
  return std::get<Number>(value);
}

std::optional<ValueView> GivenValues::at(std::size_t place) const noexcept {
  if (place < typed_.size() && typed_[place]) return view_of(*typed_[place]);
  for (const NativeValue& each : native_) {
    if (place < each.how_many) return each.view(each.at, place);
    place -= each.how_many;
  }
  return std::nullopt;
}

std::size_t value_count(ArgumentList declared) noexcept {
  std::size_t count = 0;
  for (const Argument& argument : declared) count += value_count(argument);
  return count;
}

std::size_t octets_of(ArgumentList declared) noexcept {
  std::size_t octets = 0;
  for (const Argument& argument : declared) octets += argument.octets();
  return octets;
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

Result<> write_value(OctetWriter& writer, const Argument& argument, const ValueView& value, Words words) noexcept {
  const auto* number = std::get_if<Number>(&value);
  if (number != nullptr && argument.field.type != Type::Text) {
    if (!number->is_finite()) return fail(ErrorCode::InvalidArgument, "argument is not a number");
    if (!permits(argument, *number)) return fail(ErrorCode::OutOfRange, "argument outside its range");
  }
  return put_any(writer, argument.field, value, words);
}

Result<> write_values(OctetWriter& writer, ArgumentList declared, GivenValues values, Ids ids) noexcept {
  if (values.size() > value_count(declared)) return fail(ErrorCode::InvalidArgument, "too many arguments");
  std::size_t next = 0;
  for (std::size_t id = 1; id <= declared.size(); ++id) {
    const Argument& argument = declared[id - 1];
    if (ids == Ids::One) writer.put(static_cast<std::uint8_t>(id));
    for (std::size_t i = 0; i < value_count(argument); ++i, ++next) {
      std::optional<ValueView> value = values.at(next);
      if (!value && argument.fallback) value = view_of(*argument.fallback);
      if (!value) return fail(ErrorCode::InvalidArgument, "argument missing", static_cast<std::int64_t>(id));
      HIROSCO_TRY(write_value(writer, argument, *value));
    }
  }
  return ok();
}

Result<> write_report(OctetWriter& writer, ArgumentList fields, GivenValues values) noexcept {
  if (values.size() != value_count(fields)) return fail(ErrorCode::InvalidArgument, "another number of values");
  std::size_t next = 0;
  for (const Argument& field : fields)
    for (std::size_t i = 0; i < value_count(field); ++i) {
      const auto value = values.at(next++);
      if (!value) return fail(ErrorCode::InvalidArgument, "a value missing");
      HIROSCO_TRY(put_any(writer, field.field, *value, Words::Counted));
    }
  return ok();
}

Result<Octets> all_written(const OctetWriter& writer) noexcept {
  if (!writer.good()) return fail(ErrorCode::OutOfRange, "more values than a packet holds");
  return writer.written();
}

Result<> append_value(std::vector<std::byte>& data, const Argument& argument, const Value& value) {
  return append_written(data, [&](OctetWriter& writer) { return write_value(writer, argument, view_of(value)); });
}

Result<> append_values(std::vector<std::byte>& data, ArgumentList declared, GivenValues values, Ids ids) {
  return append_written(data, [&](OctetWriter& writer) { return write_values(writer, declared, values, ids); });
}

bool take_permitted(OctetReader& reader, const Argument& argument) noexcept {
  if (argument.field.type == Type::Text) {
    const Octets words = reader.get(reader.get<std::uint16_t>());
    return permits(argument, std::string_view{reinterpret_cast<const char*>(words.data()), words.size()}) &&
           reader.good();
  }
  bool good = true;
  for (std::size_t i = 0; i < argument.field.count; ++i)
    good = permits(argument, read_number(reader, argument.field.type)) && good;
  return good && reader.good();
}

std::optional<std::size_t> first_not_permitted(ArgumentList declared, Octets data) noexcept {
  OctetReader reader{data};
  std::size_t first = 0;
  for (std::size_t place = 1; place <= declared.size(); ++place)
    if (!take_permitted(reader, declared[place - 1]) && first == 0) first = place;
  return reader.good() && reader.exhausted() ? std::optional{first} : std::nullopt;
}

std::size_t ArgumentReader::remaining() const noexcept { return value_count(declared_.subspan(next_)) - element_; }

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
  const Octets words = reader_.get(reader_.get<std::uint16_t>());
  return {reinterpret_cast<const char*>(words.data()), std::min(words.size(), most)};
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
  if (argument.field.type == Type::Bool && (wanted == "true" || wanted == "false")) return Number{wanted == "true"};
  for (const auto& named : argument.texts)
    if (lower_case(named.text) == wanted) return Number{named.value};
  return std::nullopt;
}

std::string value_text(const Argument& argument, const Value& value) {
  if (const auto* words = std::get_if<std::string>(&value)) {
    return "'" + printable_words(*words) + "'";
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
