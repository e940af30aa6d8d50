// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/people/stacks.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr OnboardTime morning{std::chrono::seconds{2'145'916'900}};

struct AStation : ::testing::Test {
  [[nodiscard]] Answered<json> keep(const std::string& name, const std::string& text, const std::string& who = "anna") {
    return stacks.keep({{"name", name}, {"text", text}}, who, morning);
  }
  std::unique_ptr<Archive> archive{std::move(*Archive::open(":memory:"))};
  Stacks stacks{*archive};
};

TEST_F(AStation, KeepsAStackForEverybodyAndForTheNextStation) {
  ASSERT_TRUE(keep("home", "hirosco tc CAMERA HOME\n"));
  ASSERT_TRUE(keep("look", "hirosco tc CAMERA LOOK\n", "bert"));
  const json found = Stacks{*archive}.list()["stacks"];
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0]["name"], "look");
  EXPECT_EQ(found[0]["who"], "bert");
  EXPECT_EQ(found[1]["text"], "hirosco tc CAMERA HOME\n");
}

TEST_F(AStation, TakesTheNewStackOfANameInPlaceOfTheOldOne) {
  ASSERT_TRUE(keep("home", "old"));
  ASSERT_TRUE(keep("home", "new", "bert"));
  const json found = Stacks{*archive}.list()["stacks"];
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0]["text"], "new");
}

TEST_F(AStation, ForgetsAStackThatIsKeptWithoutAText) {
  ASSERT_TRUE(keep("home", "text"));
  ASSERT_TRUE(keep("home", ""));
  EXPECT_TRUE(Stacks{*archive}.list()["stacks"].empty());
  EXPECT_EQ(keep("home", "").error().status, 404U);
}

TEST_F(AStation, RefusesWhatHasNoNameIsTooLongOrOneTooMany) {
  EXPECT_EQ(keep("", "text").error().status, 400U);
  EXPECT_EQ(keep(std::string(Stacks::longest_name + 1, 'x'), "text").error().status, 400U);
  EXPECT_EQ(keep("long", std::string(Stacks::longest_text + 1, 'x')).error().status, 413U);
  EXPECT_EQ(stacks.keep(json::array(), "anna", morning).error().status, 400U);
  for (std::size_t i = 0; i < Stacks::most_stacks; ++i) ASSERT_TRUE(keep("stack " + std::to_string(i), "text"));
  EXPECT_EQ(keep("another", "text").error().status, 409U);
  EXPECT_TRUE(keep("stack 3", "another text"));
}

}  // namespace
}  // namespace hirosco::ground
