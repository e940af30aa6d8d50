// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/element.hpp"

#include <algorithm>

#include "hirosco/utilities/utf8.hpp"
#include "hirosco/xml/escaped.hpp"

namespace hirosco::ground {
namespace {

[[nodiscard]] std::string words_of(std::string_view text) {
  std::string line{text};
  std::ranges::replace_if(line, [](char c) { return c == '\n' || c == '\t' || c == '\r'; }, ' ');
  return xml::escaped(printable_words(line));
}

void write(const Element& element, std::size_t depth, std::string& out) {
  out.append(2 * depth, ' ').append("<").append(element.name);
  for (const auto& [name, value] : element.attributes)
    out.append(" ").append(name).append("=\"").append(words_of(value)).append("\"");
  if (element.children.empty() && element.text.empty()) {
    out += "/>\n";
    return;
  }
  out += ">";
  if (element.children.empty()) {
    out += words_of(element.text);
  } else {
    out += "\n";
    for (const Element& child : element.children) write(child, depth + 1, out);
    out.append(2 * depth, ' ');
  }
  out.append("</").append(element.name).append(">\n");
}

[[nodiscard]] bool is_permitted(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

}  // namespace

std::string_view Element::attribute(std::string_view wanted) const noexcept {
  const auto found = std::ranges::find(attributes, wanted, [](const auto& one) { return std::string_view{one.first}; });
  return found == attributes.end() ? std::string_view{} : std::string_view{found->second};
}

std::string xml_document(const Element& root) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  write(root, 0, out);
  return out;
}

std::string XtceNames::unique(std::string_view wanted) {
  std::string name{wanted};
  std::ranges::replace_if(name, [](char c) { return !is_permitted(c); }, '_');
  if (name.empty()) name = "n";
  std::string free = name;
  for (int number = 2; !taken_.insert(free).second; ++number) free = name + "_" + std::to_string(number);
  return free;
}

}  // namespace hirosco::ground
