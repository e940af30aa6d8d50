// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/target.hpp"

#include <gtest/gtest.h>

#include <string>

namespace hirosco::ground {
namespace {

std::string path_of(const std::string& target) { return read_target(target).value_or(Target{"broken", {}}).path; }

TEST(ATarget, IsAPathAndDecodedParameters) {
  const auto target = read_target("/api/log?text=a%20b+c&limit=5&text=%C3%A9&flag&=x");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/api/log");
  EXPECT_EQ(target->parameters.size(), 5U);
  EXPECT_EQ(target->parameters.count("text"), 2U);
  EXPECT_EQ(target->text("text"), "a b c") << "of several the first";
  EXPECT_EQ(target->text("flag"), "");
  EXPECT_EQ(target->text("missing"), std::nullopt);
  EXPECT_EQ(target->parameters.find("")->second, "x");
}

TEST(ATarget, HasAPlusInItsPathAndASpaceInItsParameters) {
  EXPECT_EQ(path_of("/a+b%2Bc"), "/a+b+c");
  EXPECT_EQ(read_target("/?n=a+b%2Bc")->text("n"), "a b+c");
}

TEST(ATarget, KeepsWhatStandsBehindTheFirstSignOfEachKind) {
  const auto target = read_target("/api/log?text=a=b?c&&limit=1");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->text("text"), "a=b?c");
  EXPECT_EQ(target->text("limit"), "1");
  EXPECT_EQ(path_of("/api/log?"), "/api/log");
}

TEST(ATarget, ThatIsBrokenOrHasANulIsNone) {
  for (const char* broken : {"/%", "/%4", "/%zz", "/%4g", "/%00", "/?a=%", "/?%00=1", "/?a=%0"})
    EXPECT_FALSE(read_target(broken)) << broken;
  EXPECT_EQ(path_of("/%41%4a%4B"), "/AJK") << "either case of a digit is one, and the last may end the address";
}

TEST(ATarget, HasNumbersThatAreNumbersAndNothingElse) {
  const auto target = read_target("/?a=-1.5e3&b=1x&c=&d=inf&e=nan&f=%201&g=0x10&h=1e999");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->number("a"), -1500.0);
  for (const char* name : {"b", "c", "d", "e", "f", "g", "h", "missing"}) EXPECT_FALSE(target->number(name)) << name;
}

}  // namespace
}  // namespace hirosco::ground
