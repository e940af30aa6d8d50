// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/read/detail/element_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <tuple>

#include "hirosco/utilities/nearest.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::size_t max_quoted = 64;
constexpr std::size_t max_name = 64;

constexpr bool is_space(char c) noexcept { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
constexpr bool is_upper(char c) noexcept { return c >= 'A' && c <= 'Z'; }
constexpr bool is_letter(char c) noexcept { return is_upper(c) || (c >= 'a' && c <= 'z'); }
constexpr char lower(char c) noexcept { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; }

std::size_t characters(std::string_view text) noexcept {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string_view describe(NameKind kind) noexcept {
  switch (kind) {
    case NameKind::Plain: return "a name has 1 to 64 letters, digits and underscores and begins with no digit";
    case NameKind::Loose: return "a name has 1 to 64 letters, digits, '_', '-' and '.' and begins with no digit";
    case NameKind::Way: return "a name has 1 to 64 letters, digits, '_', '.', '[' and ']' and begins with no digit";
    case NameKind::Function: return "a function name has 1 to 16 upper-case letters, digits and underscores";
  }
  return "";
}

}  // namespace

bool is_name(std::string_view text, NameKind kind) noexcept {
  const std::size_t most = kind == NameKind::Function ? 16 : max_name;
  if (text.empty() || text.size() > most || is_digit(text.front())) return false;
  return std::ranges::all_of(text, [kind](char c) {
    if (is_digit(c) || c == '_') return true;
    if (kind == NameKind::Function) return is_upper(c);
    return is_letter(c) || (kind == NameKind::Loose && (c == '-' || c == '.')) ||
           (kind == NameKind::Way && (c == '.' || c == '[' || c == ']'));
  });
}

std::string printable(std::string_view text) {
  std::string clean;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool c1 = c == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (c1) ++i;
    if (c == '\t') clean += ' ';
    else clean += c1 || c < 0x20 || c == 0x7F ? '?' : text[i];
  }
  return clean;
}

std::string in_quotes(std::string_view text) {
  if (text.size() <= max_quoted) return fmt::format("'{}'", printable(text));
  std::size_t end = max_quoted;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return fmt::format("'{}…'", printable(text.substr(0, end)));
}

std::string did_you_mean(std::string_view text, const std::vector<std::string_view>& candidates) {
  const std::string_view found = nearest(text, candidates);
  return found.empty() ? std::string{} : fmt::format("did you mean '{}'?", found);
}

std::optional<double> to_double(std::string_view text) noexcept {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> to_integer(std::string_view text) noexcept {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (std::size_t i = 0; i < text.size();) {
    if (is_space(text[i])) {
      ++i;
      continue;
    }
    const std::size_t start = i;
    while (i < text.size() && !is_space(text[i])) ++i;
    found.push_back(text.substr(start, i - start));
  }
  return found;
}

std::string to_string(double value) { return fmt::format("{}", value); }

void Problems::add(Location at, std::string_view code, std::string message, std::string hint, std::size_t length) {
  if (full()) return;
  problems_.push_back(
      {file_, at, std::string{code}, std::move(message), std::move(hint), std::max<std::size_t>(1, length)});
}

void Problems::add(const xml::Element& element, std::string_view code, std::string message, std::string hint) {
  add(place(element.at), code, std::move(message), std::move(hint), element.name.size() + 1);
}

void Problems::add(const xml::Attribute& attribute, std::string_view code, std::string message, std::string hint) {
  add(place(attribute.value_at), code, std::move(message), std::move(hint), characters(attribute.value));
}

void Problems::warn(Location at, std::string_view code, std::string message, std::string hint, std::size_t length) {
  if (warnings_.size() >= max_problems) return;
  warnings_.push_back({file_, at, std::string{code}, std::move(message), std::move(hint),
                       std::max<std::size_t>(1, length), Grade::Warning});
}

void Problems::not_built_in(const xml::Attribute& attribute, std::string_view word, std::string hint) {
  add(attribute, "E0224", fmt::format("{} {} is not built in", attribute.name, in_quotes(word)), std::move(hint));
}

void Problems::not_built_in(const xml::Attribute& attribute, std::string hint) {
  add(place(attribute.at), "E0224", fmt::format("attribute '{}' is not built in", attribute.name), std::move(hint),
      attribute.name.size());
}

void Problems::not_built_in(const xml::Element& element, std::string hint) {
  add(element, "E0224", fmt::format("<{}> is not built in", element.name), std::move(hint));
}

namespace {
std::vector<Diagnostic> in_file_order(std::vector<Diagnostic> all) {
  std::ranges::stable_sort(all, {}, [](const Diagnostic& d) { return std::tuple{d.at.line, d.at.column}; });
  return all;
}
}  // namespace

std::vector<Diagnostic> Problems::take() { return in_file_order(std::move(problems_)); }
std::vector<Diagnostic> Problems::take_warnings() { return in_file_order(std::move(warnings_)); }

const xml::Attribute* Attributes::optional(std::string_view name) {
  if (std::ranges::find(asked_, name) == asked_.end()) asked_.push_back(name);
  return element_.find(name);
}

const xml::Attribute* Attributes::required(std::string_view name) {
  const bool first = std::ranges::find(asked_, name) == asked_.end();
  const auto* attribute = optional(name);
  if (attribute == nullptr && first)
    problems_.add(element_, "E0105", fmt::format("<{}> needs the attribute '{}'", element_.name, name));
  return attribute;
}

std::string Attributes::name(std::string_view attribute_name, NameKind kind) {
  const auto* attribute = required(attribute_name);
  if (attribute == nullptr) return {};
  if (is_name(attribute->value, kind)) return attribute->value;
  problems_.add(*attribute, "E0110", in_quotes(attribute->value) + " is not a name", std::string{describe(kind)});
  return {};
}

std::optional<std::int64_t> Attributes::integer(std::string_view name, std::int64_t minimum, std::int64_t maximum) {
  const auto* attribute = optional(name);
  if (attribute == nullptr) return std::nullopt;
  const auto value = to_integer(attribute->value);
  if (!value) {
    problems_.add(*attribute, "E0111", in_quotes(attribute->value) + " is not a whole number",
                  fmt::format("{} to {}", minimum, maximum));
    return std::nullopt;
  }
  if (*value >= minimum && *value <= maximum) return value;
  problems_.add(*attribute, "E0112", fmt::format("{} {} is out of range", name, *value),
                fmt::format("{} to {}", minimum, maximum));
  return std::nullopt;
}

std::optional<double> Attributes::number(std::string_view name) {
  const auto* attribute = optional(name);
  if (attribute == nullptr) return std::nullopt;
  const auto value = to_double(attribute->value);
  if (!value) problems_.add(*attribute, "E0111", in_quotes(attribute->value) + " is not a finite number");
  return value;
}

std::optional<Number> Attributes::exact(std::string_view name) {
  const auto* attribute = optional(name);
  if (attribute == nullptr) return std::nullopt;
  const auto value = parse_number(attribute->value);
  if (!value) problems_.add(*attribute, "E0111", in_quotes(attribute->value) + " is not a finite number");
  return value;
}

std::optional<double> Attributes::watts(std::string_view name) {
  constexpr double least_w = 1e-3, most_w = 1e6;
  const auto value = number(name);
  if (!value || (*value >= least_w && *value <= most_w)) return value;
  problems_.add(*optional(name), "E0112", fmt::format("{} {} is out of range", name, *value), "0.001 to 1000000 W");
  return std::nullopt;
}

bool Attributes::yes(std::string_view name, bool fallback) {
  const auto* attribute = optional(name);
  if (attribute == nullptr) return fallback;
  if (attribute->value == "yes") return true;
  if (attribute->value != "no")
    problems_.add(*attribute, "E0113", in_quotes(attribute->value) + " is neither 'yes' nor 'no'");
  return false;
}

void Attributes::unknown_word(const xml::Attribute& attribute, std::string_view text,
                              const std::vector<std::string_view>& known) {
  std::string hint = did_you_mean(text, known);
  if (hint.empty()) {
    hint = "one of";
    for (const std::string_view word : known) hint += fmt::format(" {}", word);
  }
  if (attribute.name == "type")
    return problems_.add(attribute, "E0104", "unknown parameter type " + in_quotes(text), hint);
  problems_.add(attribute, "E0113", fmt::format("{} {} is not known", attribute.name, in_quotes(text)), hint);
}

void Attributes::finish() {
  if (std::exchange(finished_, true)) return;
  for (const xml::Attribute& attribute : element_.attributes) {
    const std::string_view name = attribute.name;
    if (name == "xmlns" || name.starts_with("xmlns:") || name.starts_with("xsi:")) continue;
    if (std::ranges::find(asked_, name) != asked_.end()) continue;
    problems_.add(place(attribute.at), "E0103", fmt::format("<{}> has no attribute {}", element_.name, in_quotes(name)),
                  did_you_mean(name, asked_), characters(name));
  }
}

void each_child(const xml::Element& element, Problems& problems, const std::vector<Child>& known) {
  if (element.text_at.line != 0)
    problems.add(place(element.text_at), "E0108", fmt::format("text is not allowed in <{}>", element.name));
  struct Seen {
    Location first;
    std::size_t count;
  };
  std::map<std::string_view, Seen> seen;
  for (const xml::Element& child : element.children) {
    if (problems.full()) return;
    const auto found = std::ranges::find(known, child.name, &Child::name);
    if (found == known.end()) {
      std::vector<std::string_view> names;
      for (const Child& candidate : known) names.push_back(candidate.name);
      problems.add(child, "E0102",
                   fmt::format("unknown element <{}> in <{}>", printable(child.name.substr(0, 64)), element.name),
                   did_you_mean(child.name, names));
      continue;
    }
    Seen& before = seen.try_emplace(found->name, place(child.at), 0U).first->second;
    if (++before.count <= found->most) {
      found->read(child);
    } else if (found->most == 1) {
      problems.add(child, "E0107", fmt::format("a second <{}> in <{}>", child.name, element.name),
                   fmt::format("the first one is in line {}", before.first.line));
    } else if (before.count == found->most + 1) {
      problems.add(child, "E0107", fmt::format("more than {} <{}> in <{}>", found->most, child.name, element.name));
    }
  }
}

void no_children(const xml::Element& element, Problems& problems, bool text_allowed) {
  for (const xml::Element& child : element.children)
    problems.add(child, "E0102",
                 fmt::format("unknown element <{}> in <{}>", printable(child.name.substr(0, 64)), element.name));
  if (!text_allowed && element.text_at.line != 0)
    problems.add(place(element.text_at), "E0108", fmt::format("text is not allowed in <{}>", element.name));
}

bool Unique::add(const std::string& key, Location at, Problems& problems, std::size_t length, const std::string& hint) {
  std::string folded = key;
  std::ranges::transform(folded, folded.begin(), lower);
  const auto [before, first] = seen_.try_emplace(std::move(folded), key, at);
  if (first) return true;
  const auto& [used, where] = before->second;
  if (used == key)
    problems.add(at, code_,
                 fmt::format("{} {} is already used in {}:{}", what_, in_quotes(key), where.line, where.column), hint,
                 length);
  else
    problems.add(at, "E0226",
                 fmt::format("{} {} differs from {} in {}:{} in case only", what_, in_quotes(key), in_quotes(used),
                             where.line, where.column),
                 "people and file systems take them for one", length);
  return false;
}

std::optional<xml::Element> read_root(const std::filesystem::path& file, const FileSource& source,
                                      std::string_view root, Problems& problems) {
  auto content = source(file);
  if (!content) {
    problems.add(Location{}, "E0001", content.error().text, "a regular, readable file of at most 4 MiB is needed");
    return std::nullopt;
  }
  auto tree = xml::read_tree(*content);
  if (!tree) {
    const xml::Problem& problem = tree.error();
    const std::string_view code = problem.refusal == xml::Refusal::NotWellFormed ? "E0002"
                                  : problem.refusal == xml::Refusal::NotAllowed  ? "E0003"
                                                                                 : "E0004";
    problems.add(place(problem.at), code, problem.reason);
    return std::nullopt;
  }
  if (tree->name == root) return std::move(*tree);
  problems.add(*tree, "E0101",
               fmt::format("the root element is <{}>, not <{}>", printable(tree->name.substr(0, 64)), root));
  return std::nullopt;
}

Address classify_address(std::string_view text) noexcept {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return Address::Malformed;
  const auto port = to_integer(text.substr(colon + 1));
  if (!port || *port < 1 || *port > 65'535) return Address::Malformed;
  const std::string_view host = text.substr(0, colon);
  if (host == "localhost" || host == "[::1]") return Address::Loopback;
  std::size_t parts = 0;
  std::int64_t first = -1;
  for (std::size_t begin = 0; begin <= host.size(); ++parts) {
    const std::size_t end = std::min(host.find('.', begin), host.size());
    const std::string_view part = host.substr(begin, end - begin);
    const bool digits = !part.empty() && part.size() <= 3 && std::ranges::all_of(part, is_digit);
    const auto octet = digits ? to_integer(part) : std::nullopt;
    if (!octet || *octet > 255) return Address::Foreign;
    if (parts == 0) first = *octet;
    begin = end + 1;
  }
  return parts == 4 && first == 127 ? Address::Loopback : Address::Foreign;
}

}  // namespace hirosco::descriptor::detail
