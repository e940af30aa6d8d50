// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/result.hpp"

/// A telecommand as people write it, "ARM MOVE_J 0,0.5,1 SPEED=0.4": on a terminal, in a stack, in a script.
namespace hirosco::pus {

/// A word of a line, and where it begins (from 0).
struct LineWord {
  std::string text;
  std::size_t at{0};
};
/// As a shell has them where nothing is expanded: blanks between them, quotes around them, what follows a '#' is nobody's. Empty: a quote
/// is not closed.
[[nodiscard]] std::optional<std::vector<LineWord>> words_of_line(std::string_view line);

/// What a word that is neither a number nor a value of the argument stands for; the word in lower case.
using NamedNumber = std::function<std::optional<Number>(const std::string& word)>;
/// Values for the arguments of a request, of words in their order or as NAME=VALUE: numbers, names of values, on and off, those of an array
/// with commas between them. Nothing for an argument that no word gives. The place of the word that does not fit, from 0.
[[nodiscard]] std::expected<std::vector<std::optional<Value>>, std::size_t> values_given(
    const descriptor::Function& request, std::span<const std::string> words, const NamedNumber& named = {});

/// "'0.1' is no ORIENTATION, which takes 4 numbers with commas between them: 4 of -1..1": of the word at the place that values_given() told.
[[nodiscard]] std::string misfit_text(const descriptor::Function& request, std::span<const std::string> words,
                                      std::size_t place);

/// "MOVE_J GOAL[-3..3 rad] SPEED[0..1]": what a request takes.
[[nodiscard]] std::string usage_text(const descriptor::Function& request);

}  // namespace hirosco::pus
