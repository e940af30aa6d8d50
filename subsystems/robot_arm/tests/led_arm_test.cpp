// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/spacecraft/observed_flight.hpp"

/// An arm that another arm leads over a real-time link (docs/adr/0179), on virtual time, judged by what their worlds tell.
namespace hirosco {
namespace {

using Joints = std::array<double, 6>;

constexpr Joints goal{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0};

struct LedArm : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void SetUp() override {
    flown.emplace(
        simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "subsystems/robot_arm/tests/led.xml"});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  [[nodiscard]] Joints joints(const char* device) {
    const std::string words = " " + flown->craft().device(device)->truth();
    Joints found{};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::string name = fmt::format(" q{}=", i + 1);
      const auto at = words.find(name);
      found[i] = at == words.npos ? NAN : std::atof(words.c_str() + at + name.size());
    }
    return found;
  }
  [[nodiscard]] static double apart(const Joints& one, const Joints& other) {
    double most = 0;
    for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, std::abs(one[i] - other[i]));
    return most;
  }
  bool leads(const Joints& where, Duration limit = 70s) {
    std::vector<Value> numbers(where.begin(), where.end());
    numbers.emplace_back(0.5);
    return flown->craft().command("LEADER", "MOVE_J", numbers, limit).completed;
  }
  bool follows() { return flown->craft().command("ARM", "FOLLOW", {}).completed; }
  /// It has lost whoever led it on the way, and stands, in force.
  void stands_alone() {
    flown->craft().run(2s);
    EXPECT_TRUE(flown->story().has("ARM low LEAD_LOST")) << flown->story().text();
    EXPECT_EQ(flown->state("ARM"), State::Operational) << flown->story().text();
    EXPECT_EQ(flown->inhibited("ARM"), 0U);
    const Joints there = joints("arm");
    EXPECT_GT(apart(there, goal), 0.1);
    flown->craft().run(1s);
    EXPECT_LT(apart(joints("arm"), there), 1e-3);
  }
};

TEST_F(LedArm, GoesWhereTheOtherOneGoesAndNowhereBeforeItIsTold) {
  const Joints before = joints("arm");
  ASSERT_TRUE(follows()) << flown->story().text();
  ASSERT_TRUE(flown->craft().command("ARM", "HOLD", {}).completed);
  flown->craft().run(500ms);
  ASSERT_TRUE(leads(goal)) << flown->story().text();
  EXPECT_LT(apart(joints("arm"), before), 2e-3) << "HOLD has ended it";
  EXPECT_FALSE(follows()) << "the other one is far away";
  std::vector<Value> there(goal.begin(), goal.end());
  there.emplace_back(0.5);
  ASSERT_TRUE(flown->craft().command("ARM", "MOVE_J", there, 70s).completed) << flown->story().text();
  ASSERT_TRUE(follows()) << flown->story().text();
  ASSERT_TRUE(leads(before)) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_LT(apart(joints("arm"), joints("leader")), 2e-3);
  EXPECT_LT(apart(joints("arm"), before), 3e-3);
  EXPECT_EQ(flown->inhibited("ARM"), 0U);
}

TEST_F(LedArm, StandsWhenTheOneThatLeadsItDies) {
  ASSERT_TRUE(follows()) << flown->story().text();
  EXPECT_FALSE(leads(goal, 600ms)) << "it is on its way";
  flown->craft().kill("LEADER");
  stands_alone();
}

TEST_F(LedArm, StandsWhenTheOneThatLeadsItLosesItsDevice) {
  ASSERT_TRUE(follows()) << flown->story().text();
  EXPECT_FALSE(leads(goal, 600ms)) << "it is on its way";
  ASSERT_TRUE(flown->craft().device("leader")->fault("unplug"));
  flown->craft().run(2s);
  EXPECT_EQ(flown->state("LEADER"), State::Offline);
  EXPECT_TRUE(flown->story().has("ARM low LEAD_LOST") || flown->story().has("ARM info LEAD_LET_GO"))
      << flown->story().text();
  EXPECT_EQ(flown->state("ARM"), State::Operational) << flown->story().text();
  EXPECT_EQ(flown->inhibited("ARM"), 0U);
}

}  // namespace
}  // namespace hirosco
