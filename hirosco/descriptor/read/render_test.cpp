// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

using testing::text_source;

const Diagnostic problem{"mcs.xml", {2, 46}, "E0104", "unknown parameter type 'DUBLE'", "did you mean 'DOUBLE'?", 5};

TEST(Render, ShowsTheLineACaretAndTheHint) {
  const auto source = text_source("<Subsystem>\n  <ParamRef name=\"DES_POSITION\" id=\"1\" type=\"DUBLE\" />\n");
  EXPECT_EQ(render(problem, source, false),
            "mcs.xml:2:46: error: E0104: unknown parameter type 'DUBLE'\n"
            "    2 |   <ParamRef name=\"DES_POSITION\" id=\"1\" type=\"DUBLE\" />\n"
            "      |                                              ^~~~~ did you mean 'DOUBLE'?\n");
}

TEST(Render, ColoursOnlyWhenAsked) {
  const auto source = text_source("a\nb\n");
  EXPECT_EQ(render(problem, source, false).find('\x1b'), std::string::npos);
  EXPECT_NE(render(problem, source, true).find("\x1b[1;31merror:\x1b[0m"), std::string::npos);
}

TEST(Render, AWarningSaysThatItIsOne) {
  Diagnostic warning = problem;
  warning.grade = Grade::Warning;
  EXPECT_TRUE(render(warning, text_source(""), false).starts_with("mcs.xml:2:46: warning: E0104: unknown"));
}

TEST(Render, GoesWithoutTheLineWhenItIsGone) {
  const auto gone = [](const auto&) { return fail(ErrorCode::NotFound, "does not exist"); };
  EXPECT_EQ(render(problem, gone, false),
            "mcs.xml:2:46: error: E0104: unknown parameter type 'DUBLE'\n        did you mean 'DOUBLE'?\n");
  EXPECT_EQ(render({"a.xml", {}, "E0001", "cannot be read", "", 1}, gone, false),
            "a.xml: error: E0001: cannot be read\n");
}

TEST(Render, NeverPassesControlCharactersOn) {
  const auto source = text_source(
      "\x1b]0;owned\x07 \xC2\x9b"
      "31m\tx\n");
  const std::string text = render({"a.xml", {1, 1}, "E0102", "bad \x1b[2J", "h\x7f", 1}, source, false);
  EXPECT_EQ(text.find_first_of("\x1b\x07\x7f"), std::string::npos);
  EXPECT_EQ(text.find("\xC2\x9b"), std::string::npos);
}

TEST(Render, ShowsALongLineAroundThePlace) {
  const auto source = text_source(std::string(60'000, 'x') + "Y" + std::string(60'000, 'z'));
  const std::string text = render({"a.xml", {1, 60'001}, "E0102", "m", "", 50'000}, source, false);
  EXPECT_LT(text.size(), 600U);
  const std::size_t caret = text.find('^'), line = text.rfind('\n', caret);
  const std::size_t shown = text.find("    1 | ");
  EXPECT_EQ(text[shown + (caret - line - 1)], 'Y') << "the caret stands below the place";
}

}  // namespace
}  // namespace hirosco::descriptor
