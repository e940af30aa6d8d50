// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/people/authority.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace hirosco::ground {
namespace {

class OneStation : public ::testing::Test {
 protected:
  [[nodiscard]] Authority::Now now() const { return {TimePoint{passed}, OnboardTime{1000s + passed}}; }
  /// A second after the other, with these pages open.
  void pass(Duration span, const std::set<std::string>& present) {
    for (Duration done{0}; done < span; done += 1s) {
      passed += 1s;
      authority.see(present, now());
    }
  }
  [[nodiscard]] std::string holder() const {
    const auto told = authority.json(now().ground);
    return told["holder"].is_null() ? "nobody" : told["holder"]["name"].get<std::string>();
  }
  [[nodiscard]] std::string asking() const {
    const auto told = authority.json(now().ground);
    return told["asking"].is_null() ? "nobody" : told["asking"]["name"].get<std::string>();
  }
  [[nodiscard]] std::vector<std::string> actions() const {
    std::vector<std::string> list;
    for (const StoredMark& mark : marks) list.push_back(mark.who + " " + mark.action);
    return list;
  }

  Duration passed{0};
  std::vector<StoredMark> marks;
  Authority authority{[this](const StoredMark& mark) { marks.push_back(mark); }};
  const Authority::Seat anna{"a", "anna"}, ben{"b", "ben"}, cleo{"c", "cleo"}, script{"", "operator"};
  const std::set<std::string> all{"a", "b", "c"};
};

TEST_F(OneStation, WhoSendsFirstCommandsAndTheOthersAreToldWho) {
  EXPECT_TRUE(authority.may_command(anna, now()));
  EXPECT_EQ(holder(), "anna");
  const auto refused = authority.may_command(ben, now());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().status, 409U);
  EXPECT_EQ(refused.error().text, "anna commands: ask for the command, or wait until it is handed over");
  EXPECT_FALSE(authority.may_command(script, now())) << "a script is somebody, too";
  EXPECT_TRUE(authority.may_command(anna, now()));
}

TEST_F(OneStation, AScriptWithoutASeatCommandsWhereNobodyDoesAndTakesNothing) {
  EXPECT_TRUE(authority.may_command(script, now()));
  EXPECT_EQ(holder(), "nobody");
  EXPECT_EQ(authority.take(script, now()).error().status, 400U);
}

TEST_F(OneStation, WhoAsksGetsItWhenItIsHandedOver) {
  ASSERT_TRUE(authority.take(anna, now()));
  ASSERT_TRUE(authority.take(ben, now()));
  EXPECT_EQ(holder(), "anna") << "asked is not taken";
  EXPECT_EQ(asking(), "ben");
  EXPECT_EQ(authority.take(cleo, now()).error().text, "ben asks for the command already");
  EXPECT_EQ(authority.hand_over(ben, now()).error().text, "anna commands");
  ASSERT_TRUE(authority.hand_over(anna, now()));
  EXPECT_EQ(holder(), "ben");
  EXPECT_EQ(asking(), "nobody");
  EXPECT_FALSE(authority.may_command(anna, now()));
  EXPECT_EQ(actions(), (std::vector<std::string>{"anna took", "ben asked", "ben was handed"}));
}

TEST_F(OneStation, WhoKeepsItKeepsItHoweverLongTheOtherWaits) {
  ASSERT_TRUE(authority.take(anna, now()));
  ASSERT_TRUE(authority.take(ben, now()));
  ASSERT_TRUE(authority.keep(anna, now()));
  EXPECT_EQ(asking(), "nobody");
  pass(2 * Authority::answer_limit, all);
  EXPECT_EQ(holder(), "anna");
  EXPECT_EQ(authority.keep(ben, now()).error().status, 409U);
}

TEST_F(OneStation, WhoSaysNothingLosesItToWhoAsked) {
  ASSERT_TRUE(authority.take(anna, now()));
  ASSERT_TRUE(authority.take(ben, now()));
  pass(Authority::answer_limit, all);
  EXPECT_EQ(holder(), "anna");
  pass(1s, all);
  EXPECT_EQ(holder(), "ben");
  EXPECT_EQ(marks.back().action, "was left");
  EXPECT_EQ(marks.back().note, "anna");
}

TEST_F(OneStation, WhoAskedAndWentAwayGetsNothing) {
  ASSERT_TRUE(authority.take(anna, now()));
  ASSERT_TRUE(authority.take(ben, now()));
  pass(Authority::answer_limit + 1s, {"a"});
  EXPECT_EQ(holder(), "anna");
  EXPECT_EQ(asking(), "nobody");
}

TEST_F(OneStation, ItLapsesWithoutATelecommandForAQuarterOfAnHour) {
  ASSERT_TRUE(authority.take(anna, now()));
  pass(10min, all);
  EXPECT_TRUE(authority.may_command(anna, now()));
  pass(Authority::idle_limit, all);
  EXPECT_EQ(holder(), "anna");
  pass(1s, all);
  EXPECT_EQ(holder(), "nobody");
  EXPECT_EQ(marks.back().action, "was idle");
}

TEST_F(OneStation, ItOutlivesAReloadOfThePageAndNotItsEnd) {
  ASSERT_TRUE(authority.take(anna, now()));
  pass(5s, {});
  pass(5s, {"a"});
  pass(Authority::absence_limit, {});
  EXPECT_EQ(holder(), "anna");
  pass(1s, {});
  EXPECT_EQ(holder(), "nobody");
  EXPECT_EQ(marks.back().action, "was away");
  EXPECT_TRUE(authority.may_command(ben, now()));
}

TEST_F(OneStation, LaidDownItIsAnybodys) {
  ASSERT_TRUE(authority.take(anna, now()));
  ASSERT_TRUE(authority.hand_over(anna, now()));
  EXPECT_EQ(holder(), "nobody");
  EXPECT_EQ(authority.hand_over(anna, now()).error().text, "nobody commands");
}

/// Whatever is done in whatever order: never two, and who holds it is one who was told so last.
TEST_F(OneStation, InEveryOrderOfWhatThreePeopleDoAtMostOneMayCommand) {
  const std::array people{anna, ben, cleo};
  for (unsigned order = 0; order < 9 * 9 * 9 * 9; ++order) {
    Authority fresh{[](const StoredMark&) {}};
    unsigned rest = order;
    for (int step = 0; step < 4; ++step, rest /= 9) {
      const auto& who = people[rest % 9 % 3];
      const unsigned what = rest % 9 / 3;
      if (what == 0) static_cast<void>(fresh.take(who, now()));
      if (what == 1) static_cast<void>(fresh.hand_over(who, now()));
      if (what == 2) fresh.see({who.id}, {now().ground + (step + 1) * 31s, now().onboard});
      const auto told = fresh.json(now().ground);
      int may = 0;
      for (const auto& one : people) {
        Authority copy = fresh;
        const bool can = copy.may_command(one, now()).has_value();
        may += can ? 1 : 0;
        if (!told["holder"].is_null()) {
          ASSERT_EQ(can, told["holder"]["seat"] == one.id) << order;
        }
      }
      ASSERT_EQ(may, told["holder"].is_null() ? 3 : 1) << order;
    }
  }
}

}  // namespace
}  // namespace hirosco::ground
