// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/words/given_words.hpp"

#include <gtest/gtest.h>

namespace hirosco::pus {
namespace {

[[nodiscard]] std::vector<std::string> texts(std::string_view line) {
  std::vector<std::string> all;
  const auto words = words_of_line(line);
  for (const LineWord& word : words.value()) all.push_back(word.text + "@" + std::to_string(word.at));
  return all;
}
using Texts = std::vector<std::string>;

TEST(LineWords, AreThoseOfAShellThatExpandsNothing) {
  EXPECT_EQ(texts("ARM  MOVE_J 0,1"), (Texts{"ARM@0", "MOVE_J@5", "0,1@12"}));
  EXPECT_EQ(texts(R"(LAMP NAME 'good night' "a \"b\" $c" d\ e)"),
            (Texts{"LAMP@0", "NAME@5", "good night@10", "a \"b\" $c@23", "d e@36"}));
  EXPECT_EQ(texts("ARM HOLD # and rest"), (Texts{"ARM@0", "HOLD@4"}));
  EXPECT_EQ(texts("a#b $x *"), (Texts{"a#b@0", "$x@4", "*@7"}));
  EXPECT_EQ(texts("  \t"), Texts{});
  EXPECT_EQ(texts("''"), Texts{"@0"});
  EXPECT_FALSE(words_of_line("LAMP 'never closed"));
}

struct GivenWords : ::testing::Test {
  descriptor::Function move;
  GivenWords() {
    move.name = "MOVE";
    descriptor::Field goal, fast;
    goal.name = "GOAL";
    goal.count = 2;
    fast.name = "FAST";
    fast.type = Type::Uint8;
    move.arguments.push_back({.field = goal, .of = {}, .fallback = {}});
    move.arguments.push_back({.field = fast, .of = {}, .fallback = Value{Number{0}}});
  }
};

TEST_F(GivenWords, StandInOrderOrByNameAndWhatIsNotGivenIsNothing) {
  const auto in_order = values_given(move, std::vector<std::string>{"0.5,-1", "on"});
  ASSERT_TRUE(in_order);
  EXPECT_EQ(*in_order, (std::vector<std::optional<Value>>{Number{0.5}, Number{-1.0}, Number{1}}));
  const auto by_name = values_given(move, std::vector<std::string>{"fast=off", "GOAL=1,2"});
  ASSERT_TRUE(by_name);
  EXPECT_EQ((*by_name)[2], Value{Number{0}});
  const auto less = values_given(move, std::vector<std::string>{"1,2"});
  ASSERT_TRUE(less);
  EXPECT_FALSE((*less)[2]);
}

TEST_F(GivenWords, SayOfWhichArgumentOneIsNotAndWhatThatMayBe) {
  move.arguments[0].field.minimum = -3;
  move.arguments[0].field.maximum = 3;
  const auto said = [&](const Texts& words) { return misfit_text(move, words, values_given(move, words).error()); };
  EXPECT_EQ(said({"0.1"}), "'0.1' is no GOAL, which takes 2 numbers with commas between them: 2 of -3..3");
  EXPECT_EQ(said({"1,2", "fast=maybe"}), "'maybe' is no FAST, which may be 0..255");
  EXPECT_EQ(said({"fast=1", "1;2"}), "'1;2' is no GOAL, which takes 2 numbers with commas between them: 2 of -3..3");
  EXPECT_EQ(said({"1,2", "1", "7"}),
            "'7' is one too many: MOVE takes 2 arguments, numbers of one with commas and no blank between them");
}

TEST_F(GivenWords, TellWhichDoesNotFit) {
  EXPECT_EQ(values_given(move, std::vector<std::string>{"1,2,3"}).error(), 0U);
  EXPECT_EQ(values_given(move, std::vector<std::string>{"1,2", "fast=maybe"}).error(), 1U);
  EXPECT_EQ(values_given(move, std::vector<std::string>{"1,2", "1", "1"}).error(), 2U);
  EXPECT_EQ(values_given(move, std::vector<std::string>{"1,"}).error(), 0U);
  const auto named = [](const std::string& word) -> std::optional<Number> {
    return word == "quick" ? std::optional{Number{1}} : std::nullopt;
  };
  EXPECT_TRUE(values_given(move, std::vector<std::string>{"1,2", "Quick"}, named));
}

}  // namespace
}  // namespace hirosco::pus
