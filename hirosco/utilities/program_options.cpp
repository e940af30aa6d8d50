// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/program_options.hpp"

#include <algorithm>

#include "hirosco/utilities/nearest.hpp"

namespace hirosco {
namespace {

[[nodiscard]] std::string quoted(std::string_view word) { return "'" + std::string{word} + "'"; }

/// "; there are: --mission FILE, --json"
[[nodiscard]] std::string what_there_is(std::span<const ProgramOption> known) {
  std::string text;
  for (const auto& [name, value] : known) {
    text += (text.empty() ? "; there are: " : ", ") + std::string{name};
    if (!value.empty()) text += " " + std::string{value};
  }
  return text;
}

[[nodiscard]] std::string why_unknown(std::string_view word, std::span<const ProgramOption> known) {
  if (!word.starts_with('-')) return quoted(word) + " belongs to no option";
  std::vector<std::string_view> names;
  for (const ProgramOption& each : known) names.push_back(each.name);
  const std::string_view meant = nearest(word, names);
  return "no option " + quoted(word) + (meant.empty() ? "" : "; did you mean " + quoted(meant) + "?");
}

}  // namespace

std::expected<std::vector<GivenOption>, std::string> given_options(int argc, const char* const* argv,
                                                                   std::span<const ProgramOption> known) {
  const auto find = [&](std::string_view word) { return std::ranges::find(known, word, &ProgramOption::name); };
  std::vector<GivenOption> given;
  for (int i = 1; i < argc; ++i) {
    const auto option = find(argv[i]);
    if (option == known.end()) return std::unexpected{why_unknown(argv[i], known) + what_there_is(known)};
    if (option->value.empty()) {
      given.push_back({argv[i], {}});
      continue;
    }
    if (i + 1 == argc || find(argv[i + 1]) != known.end())
      return std::unexpected{std::string{option->name} + " without its " + std::string{option->value} +
                             what_there_is(known)};
    given.push_back({argv[i], argv[i + 1]});
    ++i;
  }
  return given;
}

}  // namespace hirosco
