// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/xml/reader.hpp"

/// Tools of the two descriptor readers: collecting problems, asking an element for its attributes and children.
namespace hirosco::descriptor::detail {

[[nodiscard]] constexpr Location place(xml::Position at) noexcept { return {at.line, at.column}; }

/// 'text', shortened and without control characters, so that a message is always one clean line.
[[nodiscard]] std::string in_quotes(std::string_view text);
/// Replaces control characters (C0, DEL, C1); what we print must not steer a terminal.
[[nodiscard]] std::string printable(std::string_view text);

/// "did you mean 'x'?" for the candidate nearest to `text`, or "" when none is near.
[[nodiscard]] std::string did_you_mean(std::string_view text, const std::vector<std::string_view>& candidates);

/// Finite decimal number, nothing around it.
[[nodiscard]] std::optional<double> to_double(std::string_view text) noexcept;
[[nodiscard]] std::optional<std::int64_t> to_integer(std::string_view text) noexcept;
/// Parts between white space.
[[nodiscard]] std::vector<std::string_view> words(std::string_view text);
[[nodiscard]] std::string to_string(double value);

/// 2^53: up to here every integer is a double.
inline constexpr std::int64_t max_exact_integer = std::int64_t{1} << 53;
/// More problems than this are not worth reading: reading stops, which bounds its time on hostile files.
inline constexpr std::size_t max_problems = 200;

/// "a, b and c are": the words of what is built in, each once.
template <class Rows, class Word>
[[nodiscard]] std::string are_built_in(const Rows& rows, Word word) {
  std::vector<std::string> found;
  for (const auto& row : rows)
    if (std::string text{to_text(std::invoke(word, row))}; std::ranges::find(found, text) == found.end())
      found.push_back(std::move(text));
  std::string text;
  for (std::size_t i = 0; i < found.size(); ++i)
    text += (i == 0 ? "" : i + 1 < found.size() ? ", " : " and ") + found[i];
  return text + (found.size() == 1 ? " is" : " are");
}

/// The problems of one file.
class Problems {
 public:
  explicit Problems(std::filesystem::path file) : file_{std::move(file)} {}

  void add(Location at, std::string_view code, std::string message, std::string hint = {}, std::size_t length = 1);
  /// At an element; its name is underlined.
  void add(const xml::Element& element, std::string_view code, std::string message, std::string hint = {});
  /// At an attribute's value.
  void add(const xml::Attribute& attribute, std::string_view code, std::string message, std::string hint = {});

  /// What does not keep the file from being taken.
  void warn(Location at, std::string_view code, std::string message, std::string hint = {}, std::size_t length = 1);
  /// What is known, but no code honours: one word of an attribute, an attribute as such, an element.
  void not_built_in(const xml::Attribute& attribute, std::string_view word, std::string hint);
  void not_built_in(const xml::Attribute& attribute, std::string hint);
  void not_built_in(const xml::Element& element, std::string hint);

  [[nodiscard]] std::size_t count() const noexcept { return problems_.size(); }
  [[nodiscard]] bool full() const noexcept { return problems_.size() >= max_problems; }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  /// All of them in file order.
  [[nodiscard]] std::vector<Diagnostic> take();
  [[nodiscard]] std::vector<Diagnostic> take_warnings();

 private:
  std::filesystem::path file_;
  std::vector<Diagnostic> problems_;
  std::vector<Diagnostic> warnings_;
};

/// What characters a name may have.
enum class NameKind {
  Plain,     ///< letters, digits, underscore
  Loose,     ///< also hyphen and dot: modes, plans, devices, executables
  Way,       ///< also dots and brackets: what stands in a structure within
  Function,  ///< upper case, digits, underscore, at most 16
};

[[nodiscard]] bool is_name(std::string_view text, NameKind kind) noexcept;

/// Asks one element for its attributes. Every attribute asked for is known; finish() reports the others.
class Attributes {
 public:
  Attributes(const xml::Element& element, Problems& problems) : element_{element}, problems_{problems} {}
  ~Attributes() { finish(); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;

  [[nodiscard]] const xml::Attribute* optional(std::string_view name);
  /// Reports a missing one.
  [[nodiscard]] const xml::Attribute* required(std::string_view name);

  [[nodiscard]] std::string text(std::string_view name) {
    const auto* attribute = optional(name);
    return attribute == nullptr ? std::string{} : attribute->value;
  }
  /// A required name; empty when missing or not a name.
  [[nodiscard]] std::string name(std::string_view attribute = "name", NameKind kind = NameKind::Plain);

  /// Empty when absent or reported.
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view name, std::int64_t minimum, std::int64_t maximum);
  template <class T>
  [[nodiscard]] T integer_or(std::string_view name, std::int64_t minimum, std::int64_t maximum, T fallback) {
    const auto value = integer(name, minimum, maximum);
    return value ? static_cast<T>(*value) : fallback;
  }
  template <class T>
  [[nodiscard]] T required_integer(std::string_view name, std::int64_t minimum, std::int64_t maximum) {
    return required(name) == nullptr ? T{} : integer_or<T>(name, minimum, maximum, T{});
  }
  [[nodiscard]] std::optional<double> number(std::string_view name);
  /// The same without rounding a 64-bit integer.
  [[nodiscard]] std::optional<Number> exact(std::string_view name);
  /// Electrical power, 1 mW to 1 MW.
  [[nodiscard]] std::optional<double> watts(std::string_view name);
  /// "yes" or "no"; anything else is reported and counts as no. `fallback` when absent.
  [[nodiscard]] bool yes(std::string_view name, bool fallback);

  template <class E>
  [[nodiscard]] E one_of(std::string_view name, E fallback) {
    const auto* attribute = optional(name);
    return attribute == nullptr ? fallback : word<E>(*attribute, attribute->value).value_or(fallback);
  }
  /// Several words, each at most once and at least one.
  template <class E>
  [[nodiscard]] std::vector<E> list_of(std::string_view name, std::vector<E> fallback) {
    const auto* attribute = optional(name);
    if (attribute == nullptr) return fallback;
    std::vector<E> values;
    for (const std::string_view part : words(attribute->value)) {
      const auto value = word<E>(*attribute, part);
      if (!value) continue;
      if (std::find(values.begin(), values.end(), *value) == values.end()) values.push_back(*value);
      else problems_.add(*attribute, "E0113", in_quotes(part) + " stands twice");
    }
    if (words(attribute->value).empty())
      problems_.add(*attribute, "E0109", "attribute '" + attribute->name + "' is empty");
    return values.empty() ? fallback : values;
  }
  template <class E>
  [[nodiscard]] std::optional<E> word(const xml::Attribute& attribute, std::string_view text) {
    const auto value = from_text<E>(text);
    if (value) return value;
    std::vector<std::string_view> known;
    for (const auto& row : EnumTexts<E>::table) known.push_back(row.text);
    unknown_word(attribute, text, known);
    return std::nullopt;
  }
  void unknown_word(const xml::Attribute& attribute, std::string_view text, const std::vector<std::string_view>& known);

  /// Reports attributes that nobody asked for.
  void finish();

  [[nodiscard]] const xml::Element& element() const noexcept { return element_; }

 private:
  const xml::Element& element_;
  Problems& problems_;
  std::vector<std::string_view> asked_;
  bool finished_{false};
};

/// A child element that is known here, and what reads it.
struct Child {
  std::string_view name;
  std::function<void(const xml::Element&)> read;
  std::size_t most{4096};            ///< more of them are refused
};
/// Hands each child to its reader; reports unknown ones, too many, and text between them.
/// Stops when there are `max_problems`.
void each_child(const xml::Element& element, Problems& problems, const std::vector<Child>& known);
/// For elements that have only text, or nothing at all.
void no_children(const xml::Element& element, Problems& problems, bool text_allowed = false);

/// Remembers names or ids, with their places, to report the second use of one; one in another case is the same.
class Unique {
 public:
  /// `what` begins the message: "event name".
  Unique(std::string what, std::string_view code) : what_{std::move(what)}, code_{code} {}
  /// False and a problem at `at` when `key` was there before.
  bool add(const std::string& key, Location at, Problems& problems, std::size_t length = 1,
           const std::string& hint = {});

 private:
  std::string what_;
  std::string_view code_;
  std::map<std::string, std::pair<std::string, Location>> seen_;  ///< in lower case: as written first, and where
};

/// Reads the file and its tree; reports what is wrong with them and checks the root's name.
[[nodiscard]] std::optional<xml::Element> read_root(const std::filesystem::path& file, const FileSource& source,
                                                    std::string_view root, Problems& problems);

/// Whether a "host:port" stays on this computer.
enum class Address { Loopback, Foreign, Malformed };
[[nodiscard]] Address classify_address(std::string_view text) noexcept;

/// True when the value fits the type and the range of `field`; else it is reported.
bool check_value(Problems& problems, const xml::Attribute& at, const Field& field, const Number& value);
/// "-1 to 2.5", "0 to inf"
[[nodiscard]] std::string range_text(const Field& field);
/// As many values as the fields of `name` have: numbers or the names that values of a field have, with blanks between them; of
/// one TEXT the words. Empty when something was reported.
[[nodiscard]] std::optional<std::vector<Value>> read_values(Problems& problems, const xml::Attribute& at,
                                                            std::string_view name, std::span<const Field> fields,
                                                            const std::vector<Enumeration>& enumerations);
/// As many numbers as `field` has, which a double must hold exactly; empty when the attribute is absent or reported.
[[nodiscard]] std::vector<double> read_numbers(Problems& problems, Attributes& attributes, std::string_view name,
                                               const Field& field);
/// States as a mask: bit n set for State n.
[[nodiscard]] std::uint16_t read_states(Attributes& attributes, std::string_view name, std::vector<State> fallback);
/// Cycles, by the attribute for real-time scheduling and the one without it.
[[nodiscard]] CycleLimit read_limit(Attributes& attributes, std::string_view realtime, std::string_view reduced,
                                    CycleLimit fallback);

}  // namespace hirosco::descriptor::detail
