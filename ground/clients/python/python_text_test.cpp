// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_text.hpp"

#include <gtest/gtest.h>

namespace hirosco::ground {
namespace {

TEST(PythonNames, AreValidAndUniqueWhateverTheDescriptorSays) {
  PythonNames names{{"self", "wait"}};
  EXPECT_EQ(names.variable("MOVE_TO"), "move_to");
  EXPECT_EQ(names.variable("Move To"), "move_to_2");
  EXPECT_EQ(names.variable("LAMBDA"), "lambda_2");
  EXPECT_EQ(names.variable("SELF"), "self_2");
  EXPECT_EQ(names.variable("__init__"), "init");
  EXPECT_EQ(names.variable("3D"), "n3d");
  EXPECT_EQ(names.variable("\xC3\xA9\"\n"), "n");
  EXPECT_EQ(names.variable(""), "n_2");
  EXPECT_EQ(names.type("END_EFFECTOR"), "EndEffector");
  EXPECT_EQ(names.type("NONE"), "None_2");
}

TEST(PythonString, IsAsciiAndKeepsItsQuotes) {
  EXPECT_EQ(python_string("a\"b\\c\n"), R"("a\"b\\c\x0a")");
  EXPECT_EQ(python_string("\xC2\xB0"
                          "C"),
            R"("\u00b0C")");
  EXPECT_EQ(python_string("\xF0\x9F\x9A\x80"), R"("\U0001f680")");
  EXPECT_EQ(python_string("\xE2\x80"), R"("\ufffd\ufffd")");
}

TEST(PythonDocstring, HasEachParagraphOnALineOfItsOwnAndNeverEndsEarly) {
  EXPECT_EQ(doc(" a\n\t b \"\"\" "), R"(a b \"\"\")");
  EXPECT_EQ(docstring("  ", {"one"}), "  \"\"\"one\"\"\"\n");
  EXPECT_EQ(docstring("  ", {"one", "", "two"}), "  \"\"\"one\n\n  two\n  \"\"\"\n");
}

}  // namespace
}  // namespace hirosco::ground
