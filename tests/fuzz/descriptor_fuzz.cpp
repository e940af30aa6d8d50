// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/xml/reader.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/problems.hpp"

/// XML, a subsystem's descriptor and a manifest from whatever text comes. A tree is within its bounds and read the same when it is written again;
/// what is refused has problems with their places; a descriptor that was taken is taken by who flies it and reads it again.
namespace {

using namespace hirosco;
using fuzz::expect;

[[nodiscard]] std::size_t nodes_of(const xml::Element& element, std::size_t depth) {
  expect(depth <= xml::max_depth, "a tree is not deeper than it may be");
  std::size_t nodes = 1 + element.attributes.size();
  for (const auto& child : element.children) nodes += nodes_of(child, depth + 1);
  return nodes;
}

/// Every character of ASCII that could mean something as its number.
[[nodiscard]] std::string escaped(std::string_view value) {
  std::string text;
  for (const char letter : value) {
    const auto octet = static_cast<unsigned char>(letter);
    const bool plain = octet >= 0x80 || (octet >= '0' && octet <= '9') || (octet >= 'A' && octet <= 'Z') ||
                       (octet >= 'a' && octet <= 'z');
    if (plain) text += letter;
    else text += "&#" + std::to_string(octet) + ";";
  }
  return text;
}

/// Without its text.
[[nodiscard]] std::string written(const xml::Element& element) {
  std::string text = "<" + element.name;
  for (const auto& each : element.attributes) text += " " + each.name + "=\"" + escaped(each.value) + "\"";
  text += ">";
  for (const auto& child : element.children) text += written(child);
  return text + "</" + element.name + ">";
}

[[nodiscard]] bool same(const xml::Element& one, const xml::Element& other) {
  const auto same_attribute = [](const xml::Attribute& a, const xml::Attribute& b) {
    return a.name == b.name && a.value == b.value;
  };
  return one.name == other.name && std::ranges::equal(one.attributes, other.attributes, same_attribute) &&
         std::ranges::equal(one.children, other.children, same);
}

void check_tree(std::string_view text) {
  const auto tree = xml::read_tree(text);
  if (!tree) {
    expect(tree.error().at.line >= 1 && tree.error().at.column >= 1 && !tree.error().reason.empty(),
           "why a document is refused has a place");
    return;
  }
  fuzz::taken();
  expect(nodes_of(*tree, 1) <= xml::max_tree_nodes, "a tree is not larger than it may be");
  const auto again = xml::read_tree(written(*tree));
  expect(again && same(*again, *tree), "a tree is written and read the same");
}

void check_manifest(const descriptor::FileSource& source, std::string_view text) {
  const auto reading = descriptor::read_manifest("fuzzed.sha256", source);
  fuzz::check_reading(reading, "fuzzed.sha256", text, source);
  if (!reading.value) return;
  for (const auto& each : reading.value->listed)
    expect(each.digest.size() == descriptor::digest_digits && reading.value->find(each.file) == &each,
           "a program has one digest");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text{fuzz::text_of(data, size)};
  const descriptor::FileSource source = [&](const std::filesystem::path&) -> Result<std::string> { return text; };
  check_tree(text);
  check_manifest(source, text);
  const auto reading = descriptor::read_subsystem("fuzzed.xml", source);
  fuzz::check_reading(reading, "fuzzed.xml", text, source);
  if (reading.value)
    expect(descriptor::read_again(*reading.value, text, {}).value.has_value(), "what flies can be read again");
  return 0;
}
