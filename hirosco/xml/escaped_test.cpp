// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/xml/escaped.hpp"

#include <gtest/gtest.h>

#include "hirosco/xml/reader.hpp"

namespace hirosco::xml {
namespace {

TEST(Escaped, IsReadAsTheTextThatItWasInAnElementAndInAnAttribute) {
  const std::string text = R"(a < b && "c" > 'd' &amp; )";
  const auto read = read_tree("<E a=\"" + escaped(text) + "\">" + escaped(text) + "</E>");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->find("a")->value, text);
  EXPECT_EQ(escaped("plain"), "plain");
}

}  // namespace
}  // namespace hirosco::xml
