// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/program_options.hpp"

#include <gtest/gtest.h>

#include <array>

namespace hirosco {
namespace {

constexpr std::array known{ProgramOption{"--mission", "FILE"}, ProgramOption{"--json"}, ProgramOption{"--set", "TEXT"}};

/// What a program hears: "NAME=VALUE " of each option, or why it is refused.
[[nodiscard]] std::string heard(std::vector<const char*> words) {
  words.insert(words.begin(), "program");
  const auto given = given_options(static_cast<int>(words.size()), words.data(), known);
  if (!given) return given.error();
  std::string text;
  for (const auto& [name, value] : *given) text += std::string{name} + "=" + std::string{value} + " ";
  return text;
}

TEST(ProgramOptions, AreTakenInOrderAndAsOftenAsTheyWereSaid) {
  EXPECT_EQ(heard({}), "");
  EXPECT_EQ(heard({"--set", "B=2", "--json", "--mission", "pair.xml", "--set", "A=1"}),
            "--set=B=2 --json= --mission=pair.xml --set=A=1 ");
}

TEST(ProgramOptions, AValueMayBeEmptyOrLookLikeAnOptionThatThereIsNot) {
  EXPECT_EQ(heard({"--mission", "", "--set", "-1"}), "--mission= --set=-1 ");
  EXPECT_EQ(heard({"--mission", "--odd"}), "--mission=--odd ");
}

TEST(ProgramOptions, AnUnknownOneIsRefusedWithTheOneThatIsNear) {
  EXPECT_EQ(heard({"--json", "--bogus", "x"}), "no option '--bogus'; there are: --mission FILE, --json, --set TEXT");
  EXPECT_EQ(heard({"--jsno"}),
            "no option '--jsno'; did you mean '--json'?; there are: --mission FILE, --json, --set TEXT");
  EXPECT_EQ(heard({"--mission=pair.xml"}).substr(0, 34), "no option '--mission=pair.xml'; th");
}

TEST(ProgramOptions, OneWithoutItsValueIsRefused) {
  const std::string_view told = "--mission without its FILE; there are: --mission FILE, --json, --set TEXT";
  EXPECT_EQ(heard({"--mission"}), told);
  EXPECT_EQ(heard({"--mission", "--json"}), told);
}

TEST(ProgramOptions, AWordThatBelongsToNoneIsRefused) {
  const std::string_view told = "'yes' belongs to no option; there are: --mission FILE, --json, --set TEXT";
  EXPECT_EQ(heard({"--json", "yes"}), told);
  EXPECT_EQ(heard({"yes"}), told);
}

TEST(ProgramOptions, OfAProgramWithoutAnyWordsNothingIsSaid) {
  const auto given = given_options(0, nullptr, known);
  ASSERT_TRUE(given);
  EXPECT_TRUE(given->empty());
}

}  // namespace
}  // namespace hirosco
