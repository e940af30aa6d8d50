// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "hirosco/xml/reader.hpp"

int main() {
  const auto tree = hirosco::xml::read_tree("<Subsystem name=\"LAMP\">\n  <ParamRef type=\"DOUBLE\"/>\n</Subsystem>");
  if (!tree) return 1;
  const auto* type = tree->children.front().find("type");
  std::printf("%s: line %d, column %d\n", type->value.c_str(), type->value_at.line, type->value_at.column);

  const auto broken = hirosco::xml::read_tree("<Subsystem>\n  <ParamRef></Subsystem>");
  if (broken) return 1;
  std::printf("%d:%d: %s\n", broken.error().at.line, broken.error().at.column, broken.error().reason.c_str());
}
