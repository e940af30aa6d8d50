// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

// Octets of UTF-8 are negative where `char` has a sign, and are not where it has none: JSON is the same on both (RFC 8259, 7 and 8.1).
TEST(JsonText, KeepsLettersBeyondAsciiOnEveryProcessor) {
  EXPECT_EQ(json_text("/m/M\xC3\xBCnchen \xE2\x86\x92 \xF0\x9F\x9B\xB0"),
            "/m/M\xC3\xBCnchen \xE2\x86\x92 \xF0\x9F\x9B\xB0");
}

TEST(JsonText, EscapesQuotesAndBackslashes) { EXPECT_EQ(json_text(R"(say "no\yes")"), R"(say \"no\\yes\")"); }

TEST(JsonText, HasASpaceForAControlCharacterAndForWhatIsNoUtf8) {
  EXPECT_EQ(json_text("a\nb\x1F"
                      "c"),
            "a b c");
  EXPECT_EQ(json_text("lone \xBC, cut short \xE2\x86"), "lone  , cut short   ");
}

}  // namespace
}  // namespace hirosco::tools
