// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// XML that is written: elements as plain data, and names that XTCE permits.
namespace hirosco::ground {

struct Element {
  std::string name{};
  std::vector<std::pair<std::string, std::string>> attributes{};
  std::vector<Element> children{};
  std::string text{};  ///< of an element without children

  /// The attribute's value; empty: it has none of this name.
  [[nodiscard]] std::string_view attribute(std::string_view wanted) const noexcept;
};

/// A whole document in UTF-8. What is no UTF-8, or a character that XML does not permit, becomes a '?'.
[[nodiscard]] std::string xml_document(const Element& root);

/// Names of one scope. XTCE permits no '.', '/', ':', '[', ']' and no space; others than letters, digits, '_' and '-' become '_' too.
class XtceNames {
 public:
  XtceNames() = default;
  explicit XtceNames(std::set<std::string> taken) : taken_{std::move(taken)} {}
  /// One that is taken gets a number: "SPRING_2".
  [[nodiscard]] std::string unique(std::string_view wanted);

 private:
  std::set<std::string> taken_;
};

}  // namespace hirosco::ground
