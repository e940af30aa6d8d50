// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/columns.hpp"

#include <gtest/gtest.h>
#include <locale.h>
#include <wchar.h>

namespace hirosco::terminal {
namespace {

TEST(Columns, AWideCharacterTakesTwoAndOneThatCombinesNone) {
  EXPECT_EQ(width_of("arm"), 3U);
  EXPECT_EQ(width_of("m\xc3\xa4\xc3\x9f"), 3U);       // mäß
  EXPECT_EQ(width_of("\xe6\x89\x8b"), 2U);            // a Han character
  EXPECT_EQ(width_of("\xf0\x9f\x9b\xb0"), 1U);        // U+1F6F0, a satellite: neutral in Unicode
  EXPECT_EQ(width_of("\xf0\x9f\x9a\x80"), 2U);        // U+1F680, a rocket: wide
  EXPECT_EQ(width_of("a\xcc\x88"), 1U);               // a and a combining diaeresis
}

TEST(Columns, WhatTheScreenItselfShowsIsAsTheLibraryHasIt) {
  const locale_t unicode = ::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
  ASSERT_NE(unicode, nullptr);
  const locale_t before = ::uselocale(unicode);
  for (wchar_t letter = 0x21; letter < 0x3000; ++letter) {
    std::string text(8, '\0');
    text.resize(::wcrtomb(text.data(), letter, nullptr));
    const int columns = ::wcwidth(letter);
    EXPECT_EQ(width_of(text), columns < 0 ? 1U : static_cast<unsigned>(columns))
        << std::hex << static_cast<int>(letter);
  }
  ::uselocale(before);
  ::freelocale(unicode);
}

TEST(Columns, WhatSteersATerminalOrIsNoTextIsAQuestionMark) {
  EXPECT_EQ(left("\x1b[2J", 6), "?[2J  ");
  EXPECT_EQ(left("\xff\xfe", 3), "?? ");
  EXPECT_EQ(left("\xc2\x9b", 2), "? ");               // C1: CSI
}

TEST(Columns, CutsToItsWidthAndSaysSo) {
  EXPECT_EQ(cut("SOLAR_ARRAY", 11), "SOLAR_ARRAY");
  EXPECT_EQ(cut("SOLAR_ARRAY", 10), "SOLAR_ARR…");
  EXPECT_EQ(cut("SOLAR_ARRAY", 1), "…");
  EXPECT_EQ(cut("SOLAR_ARRAY", 0), "");
  EXPECT_EQ(cut("", 0), "");
}

TEST(Columns, NeverCutsThroughAWideCharacter) {
  const char* three = "\xe6\x89\x8b\xe6\x89\x8b\xe6\x89\x8b";  // six columns
  for (std::size_t width = 0; width <= 7; ++width) {
    const std::string shown = cut(three, width);
    EXPECT_LE(width_of(shown), width) << width;
    EXPECT_EQ(width_of(left(three, width)), width);
    EXPECT_EQ(width_of(right(three, width)), width);
  }
}

TEST(Columns, StandInASCIIAsWideAsInUnicode) {
  for (const char* text : {"● ARM → HAND …", "m\xc3\xa4\xc3\x9f", "\xe6\x89\x8b!", "plain"}) {
    const std::string shown = ascii(text);
    EXPECT_EQ(shown.size(), width_of(text)) << shown;
    for (const char letter : shown) EXPECT_TRUE(letter >= ' ' && letter < 127);
  }
  EXPECT_EQ(ascii("● ARM → HAND …"), "* ARM > HAND ~");
}

}  // namespace
}  // namespace hirosco::terminal
