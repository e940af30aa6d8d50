// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/words/given_words.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

#include "hirosco/pus/service/arguments.hpp"
#include "hirosco/utilities/lower_case.hpp"

namespace hirosco::pus {
namespace {

/// Which argument a word is for, and what it says of it.
struct Meant {
  std::size_t argument{0};  ///< past the end: none is left for it
  std::string text;
};
/// `next` counts the words without a name.
[[nodiscard]] Meant meant(const descriptor::Function& request, const std::string& word, std::size_t& next) {
  const auto known = std::ranges::find_if(request.arguments, [&](const Argument& argument) {
    return lower_case(argument.field.name) == lower_case(word.substr(0, word.find('=')));
  });
  if (word.find('=') == std::string::npos || known == request.arguments.end()) return {next++, word};
  return {static_cast<std::size_t>(known - request.arguments.begin()), word.substr(word.find('=') + 1)};
}

/// Empty: they do not fit.
[[nodiscard]] std::vector<std::optional<Value>> values_of(const std::string& word, const Argument& argument,
                                                          const NamedNumber& named) {
  std::vector<std::optional<Value>> values;
  const bool list = value_count(argument) != 1;
  for (std::size_t begin = 0; begin <= word.size();) {
    const std::size_t end = list ? std::min(word.find(',', begin), word.size()) : word.size();
    const std::string text = word.substr(begin, end - begin);
    auto value = parse_value(argument, text);
    if (!value) {
      const std::string lower = lower_case(text);
      std::optional<Number> number = named ? named(lower) : std::nullopt;
      if (!number && lower == "on") number = Number{1};
      if (!number && lower == "off") number = Number{0};
      if (number) value = *number;
    }
    if (!value) return {};
    values.push_back(std::move(value));
    begin = end + 1;
  }
  if (values.size() != value_count(argument)) values.clear();
  return values;
}

}  // namespace

std::optional<std::vector<LineWord>> words_of_line(std::string_view line) {
  std::vector<LineWord> words;
  std::optional<LineWord> word;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char letter = line[i];
    const bool more = i + 1 < line.size();
    const auto begin = [&] {
      if (!word) word = LineWord{{}, i};
    };
    if (quote != 0) {
      if (letter == quote) quote = 0;
      else if (letter == '\\' && quote == '"' && more &&
               std::string_view{"\"\\$`"}.find(line[i + 1]) != std::string_view::npos)
        word->text += line[++i];
      else word->text += letter;
    } else if (letter == '\'' || letter == '"') {
      begin();
      quote = letter;
    } else if (letter == '\\' && more) {
      begin();
      word->text += line[++i];
    } else if (std::isspace(static_cast<unsigned char>(letter)) != 0) {
      if (word) words.push_back(std::move(*word));
      word.reset();
    } else if (letter == '#' && !word) {
      break;
    } else {
      begin();
      word->text += letter;
    }
  }
  if (word) words.push_back(std::move(*word));
  if (quote != 0) return std::nullopt;
  return words;
}

std::expected<std::vector<std::optional<Value>>, std::size_t> values_given(const descriptor::Function& request,
                                                                           std::span<const std::string> words,
                                                                           const NamedNumber& named) {
  std::vector<std::vector<std::optional<Value>>> given;
  for (const Argument& argument : request.arguments) given.emplace_back(value_count(argument), std::nullopt);
  std::size_t next = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto [index, text] = meant(request, words[i], next);
    auto values =
        index < given.size() ? values_of(text, request.arguments[index], named) : std::vector<std::optional<Value>>{};
    if (values.empty()) return std::unexpected{i};
    given[index] = std::move(values);
  }
  std::vector<std::optional<Value>> values;
  for (auto& of_argument : given) std::ranges::move(of_argument, std::back_inserter(values));
  return values;
}

std::string misfit_text(const descriptor::Function& request, std::span<const std::string> words, std::size_t place) {
  std::size_t next = 0;
  Meant found;
  for (std::size_t i = 0; i <= place && i < words.size(); ++i) found = meant(request, words[i], next);
  if (found.argument >= request.arguments.size()) {
    const std::size_t count = request.arguments.size();
    return "'" + found.text + "' is one too many: " + request.name + " takes " + std::to_string(count) +
           (count == 1 ? " argument" : " arguments") + ", numbers of one with commas and no blank between them";
  }
  const Argument& argument = request.arguments[found.argument];
  std::string text = "'" + found.text + "' is no " + argument.field.name + ", ";
  if (const std::size_t count = value_count(argument); count > 1)
    return text + "which takes " + std::to_string(count) + " numbers with commas between them: " + range_text(argument);
  return text + "which may be " + range_text(argument);
}

std::string usage_text(const descriptor::Function& request) {
  std::string text = request.name;
  for (const Argument& argument : request.arguments)
    text += " " + argument.field.name + "[" + range_text(argument) + "]";
  return text;
}

}  // namespace hirosco::pus
