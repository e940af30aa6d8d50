// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t max_cycles = 1'000'000;

[[nodiscard]] std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  return first == text.npos ? std::string_view{} : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// The names that the values of a field have, if any: of its enumeration, or of a switch.
[[nodiscard]] std::vector<EnumerationText> names_of(const Field& field, const std::vector<Enumeration>& enumerations) {
  if (field.type == Type::Bool) return {{0, "false"}, {1, "true"}, {0, "off"}, {1, "on"}};
  const auto found = std::ranges::find(enumerations, field.enumeration, &Enumeration::name);
  return field.enumeration.empty() || found == enumerations.end() ? std::vector<EnumerationText>{} : found->texts;
}

/// The values of one attribute, taken field by field.
class ValueReader {
 public:
  ValueReader(Problems& problems, const xml::Attribute& at, const std::vector<Enumeration>& enumerations)
      : problems_{problems}, at_{at}, enumerations_{enumerations} {}

  [[nodiscard]] std::optional<Value> words_of(const Field& field) {
    const std::string& words = at_.value;
    if (is_text(words) && words.size() <= field.text_octets) return words;
    problems_.add(at_, "E0207", fmt::format("{} is longer than {} octets", in_quotes(words), field.text_octets));
    return std::nullopt;
  }
  /// `written`: a number, or a name in any case.
  [[nodiscard]] std::optional<Value> value_of(const Field& field, std::string_view written) {
    const auto names = names_of(field, enumerations_);
    const auto named = std::ranges::find_if(
        names, [&](const auto& known) { return lower_case(known.text) == lower_case(std::string{written}); });
    const auto number = named != names.end() ? Number{named->value} : parse_number(written);
    if (number) return check_value(problems_, at_, field, *number) ? std::optional<Value>{*number} : std::nullopt;
    std::vector<std::string_view> known;
    for (const auto& each : names) known.push_back(each.text);
    problems_.add(at_, "E0111",
                  fmt::format("{} is not a finite number{}", in_quotes(written),
                              known.empty() ? "" : fmt::format(", nor a value of '{}'", field.name)),
                  did_you_mean(written, known));
    return std::nullopt;
  }

 private:
  Problems& problems_;
  const xml::Attribute& at_;
  const std::vector<Enumeration>& enumerations_;
};

}  // namespace

bool check_value(Problems& problems, const xml::Attribute& at, const Field& field, const Number& value) {
  if (is_integer(field.type) && value.real() != std::trunc(value.real())) {
    problems.add(
        at, "E0208",
        fmt::format("{} is not a whole number, '{}' is {}", to_string(value), field.name, to_text(field.type)));
    return false;
  }
  const TypeRange range = range_of(field.type);
  if (value < range.lowest || value > range.highest) {
    problems.add(at, "E0208", fmt::format("{} does not fit {}", to_string(value), to_text(field.type)),
                 fmt::format("{} to {}", to_string(range.lowest), to_string(range.highest)));
    return false;
  }
  if ((field.minimum && value < *field.minimum) || (field.maximum && value > *field.maximum)) {
    problems.add(at, "E0207", fmt::format("{} is outside the range of '{}'", to_string(value), field.name),
                 range_text(field));
    return false;
  }
  return true;
}

std::string range_text(const Field& field) {
  return fmt::format("{} to {}", field.minimum ? to_string(*field.minimum) : "-inf",
                     field.maximum ? to_string(*field.maximum) : "inf");
}

std::optional<std::vector<Value>> read_values(Problems& problems, const xml::Attribute& at, std::string_view name,
                                              std::span<const Field> fields,
                                              const std::vector<Enumeration>& enumerations) {
  ValueReader reader{problems, at, enumerations};
  std::vector<Value> values;
  const auto take = [&](std::optional<Value> value) {
    if (value) values.push_back(std::move(*value));
    return value.has_value();
  };
  // Words, and the name of a value, may have blanks in them: they stand alone.
  if (fields.size() == 1 && fields.front().type == Type::Text)
    return take(reader.words_of(fields.front())) ? std::optional{std::move(values)} : std::nullopt;
  if (std::ranges::find(fields, Type::Text, &Field::type) != fields.end()) {
    problems.add(at, "E0208", fmt::format("'{}' has words among its members", name), "set its members one by one");
    return std::nullopt;
  }
  if (trimmed(at.value).empty()) {
    problems.add(at, "E0109", fmt::format("attribute '{}' is empty", at.name));
    return std::nullopt;
  }
  std::size_t count = 0;
  for (const Field& field : fields) count += field.count;
  const bool named = count == 1 && !names_of(fields.front(), enumerations).empty();
  const auto parts = named ? std::vector{trimmed(at.value)} : words(at.value);
  // What is no value at all is told before how many there are.
  auto field = fields.begin();
  std::size_t element = 0;
  for (std::size_t i = 0; i < std::min(parts.size(), count); ++i) {
    if (!take(reader.value_of(*field, parts[i]))) return std::nullopt;
    if (++element < field->count) continue;
    element = 0;
    ++field;
  }
  if (parts.size() == count) return values;
  problems.add(at, "E0209",
               fmt::format("'{}' has {} value{}, not {}", name, count, count == 1 ? "" : "s", parts.size()));
  return std::nullopt;
}

std::vector<double> read_numbers(Problems& problems, Attributes& attributes, std::string_view name,
                                 const Field& field) {
  const auto* at = attributes.optional(name);
  if (at == nullptr) return {};
  const auto values = read_values(problems, *at, field.name, {&field, 1}, {});
  std::vector<double> numbers;
  for (const Value& value : values.value_or(std::vector<Value>{})) {
    const Number& number = std::get<Number>(value);
    if (is_integer(field.type) && (number > Number{max_exact_integer} || number < Number{-max_exact_integer})) {
      problems.add(*at, "E0208", fmt::format("{} does not fit {}", to_string(number), to_text(field.type)),
                   fmt::format("whole numbers up to {}", max_exact_integer));
      return {};
    }
    numbers.push_back(number.real());
  }
  return numbers;
}

std::uint16_t read_states(Attributes& attributes, std::string_view name, std::vector<State> fallback) {
  unsigned states = 0;
  for (const State state : attributes.list_of<State>(name, std::move(fallback)))
    states |= 1U << static_cast<unsigned>(state);
  return static_cast<std::uint16_t>(states);
}

CycleLimit read_limit(Attributes& attributes, std::string_view realtime, std::string_view reduced,
                      CycleLimit fallback) {
  CycleLimit limit;
  limit.realtime = attributes.integer_or<std::uint32_t>(realtime, 1, max_cycles, fallback.realtime);
  // A limit that was raised for real time is not to be tighter without it.
  limit.reduced =
      attributes.integer_or<std::uint32_t>(reduced, 1, max_cycles, std::max(fallback.reduced, limit.realtime));
  return limit;
}

}  // namespace hirosco::descriptor::detail
