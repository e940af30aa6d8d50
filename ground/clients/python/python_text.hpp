// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

/// Text of a Python module: whatever a descriptor says arrives as a string literal or a safe identifier.
namespace hirosco::ground {

/// Identifiers of one scope of Python. A name that is taken or a keyword gets a number: "lambda_2".
class PythonNames {
 public:
  explicit PythonNames(std::set<std::string> taken) : taken_{std::move(taken)} {}
  /// "MOVE_TO" becomes "move_to". Never begins with an underscore, so it is never one of the client's own.
  [[nodiscard]] std::string variable(std::string_view name);
  /// "MOVE_TO" becomes "MoveTo".
  [[nodiscard]] std::string type(std::string_view name);

 private:
  [[nodiscard]] std::string unique(std::string name);
  std::set<std::string> taken_;
};

/// A string literal of Python in ASCII, whatever the octets are.
[[nodiscard]] std::string python_string(std::string_view text);
/// A sentence of a description on one line, for the inside of a docstring.
[[nodiscard]] std::string doc(std::string_view text);
/// One line a paragraph, which doc() has made safe.
[[nodiscard]] std::string docstring(const std::string& indent, const std::vector<std::string>& paragraphs);

template <class List, class Text>
[[nodiscard]] std::string joined(const List& list, std::string_view between, Text text) {
  std::string result;
  for (const auto& one : list) result += (result.empty() ? "" : std::string{between}) + text(one);
  return result;
}

}  // namespace hirosco::ground
