// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/spacecraft/observed_flight.hpp"

/// An arm whose gears give way (docs/adr/0182), on virtual time: its law knows rigid links and has the drives' side of the springs alone. What
/// becomes of the links the world tells.
namespace hirosco {
namespace {

using Joints = std::array<double, 6>;

constexpr Joints start{0.2, 0.5, 1.2, -0.6, 0.7, 0.1};
constexpr Joints goal{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0};

/// By how much the links were ahead of their drives, cycle by cycle.
using Springs = std::vector<Joints>;

/// Between the most and the least of the joint that swings most, rad.
[[nodiscard]] double swing(const Springs& springs, std::size_t from = 0) {
  double most = 0;
  for (std::size_t joint = 0; joint < Joints{}.size(); ++joint) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = from; i < springs.size(); ++i) {
      low = std::min(low, springs[i][joint]);
      high = std::max(high, springs[i][joint]);
    }
    most = std::max(most, high - low);
  }
  return most;
}

[[nodiscard]] double apart(const Joints& one, const Joints& other) {
  double most = 0;
  for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, std::abs(one[i] - other[i]));
  return most;
}

struct SprungArm : ::testing::Test {
  std::optional<simulation::Flight> flown;
  Springs springs;

  void SetUp() override {
    flown.emplace(simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} /
                                              "subsystems/robot_arm/tests/sprung.xml"});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
    flown->craft().on_cycle([this](std::string_view subsystem, TimePoint) {
      if (subsystem == "ARM") springs.push_back(told("spring_"));
    });
  }
  simulation::SimulatedDevice& arm() { return *flown->craft().device("arm"); }
  /// Of each joint: q, qd or spring_ and its number.
  Joints told(const char* what) {
    const std::string words = " " + arm().truth();
    Joints found{};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::string name = fmt::format(" {}{}=", what, i + 1);
      const auto at = words.find(name);
      found[i] = at == words.npos ? NAN : std::atof(words.c_str() + at + name.size());
    }
    return found;
  }
  /// What its springs have done meanwhile.
  Springs taken() { return std::exchange(springs, {}); }
  simulation::CommandOutcome move_j(const Joints& where) {
    std::vector<Value> numbers(where.begin(), where.end());
    numbers.emplace_back(1.0);
    return flown->craft().command("ARM", "MOVE_J", numbers, 70s);
  }
  /// Cycles of this until no link is farther than so much from where it rests in the end.
  static std::size_t settled_after(const Springs& springs, double within_rad) {
    const auto far = std::find_if(springs.rbegin(), springs.rend(),
                                  [&](const Joints& each) { return !(apart(each, springs.back()) < within_rad); });
    return static_cast<std::size_t>(springs.rend() - far);
  }
};

/// Contacts count from a third of the default on: what swings is none. Of springs without damping the same world
/// swings by 0.29 and 0.46 mrad when it is to rest.
TEST_F(SprungArm, ReachesItsGoalsComesToRestAndFeelsNobody) {
  constexpr double contact_share = 0.1, settled_rad = 1e-4, rests_rad = 5e-5;
  constexpr std::size_t settled_ms = 500, rest_ms = 200;
  ASSERT_TRUE(flown->craft().command("ARM", "SET_CONTACT", {std::uint8_t{1}, contact_share}).completed)
      << flown->story().text();
  for (const Joints& where : {goal, start}) {
    static_cast<void>(taken());
    const auto outcome = move_j(where);
    ASSERT_TRUE(outcome.completed) << flown->story().text();
    const double off_rad = apart(told("q"), where);
    const Springs moving = taken();
    flown->craft().run(1200ms);
    const Springs after = taken();
    ASSERT_GT(after.size(), 1100U);
    const double rest_rad = swing(after, after.size() - rest_ms);
    const Joints given_way = told("spring_");
    std::cout << fmt::format(
        "  drives {:.2f} mrad off, links {:.2f} mrad from their drives; springs moved by {:.2f} mrad on the way, were "
        "within {:g} mrad {} ms after it, and swing by {:.4f} mrad\n",
        1e3 * off_rad, 1e3 * apart(given_way, Joints{}), 1e3 * swing(moving), 1e3 * settled_rad,
        settled_after(after, settled_rad), 1e3 * rest_rad);
    EXPECT_LE(off_rad, 1e-3) << "it is measured at the drives";
    EXPECT_LT(apart(told("q"), where), 1e-3) << "and stays there";
    EXPECT_GT(swing(moving), 1e-3) << "its gears gave way";
    EXPECT_LT(swing(moving), 0.02);
    EXPECT_LE(settled_after(after, settled_rad), settled_ms);
    EXPECT_LT(rest_rad, rests_rad) << "it rings";
    EXPECT_LT(apart(told("qd"), Joints{}), 1e-3);
  }
  EXPECT_FALSE(flown->story().has("CONTACT JOINT")) << flown->story().text();
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  EXPECT_EQ(flown->inhibited("ARM"), 0U) << flown->story().text();
}

/// It is not deaf either: through its springs it feels who pushes its tool, and stands there.
TEST_F(SprungArm, StaysWhereItMeetsSomebody) {
  flown->craft().on_cycle([this, cycles = 0](std::string_view subsystem, TimePoint) mutable {
    if (subsystem != "ARM") return;
    ++cycles;
    if (cycles == 500 || cycles == 900) {
      ASSERT_TRUE(arm().fault(cycles == 500 ? "push 0 120 0" : "push 0 0 0"));
    }
  });
  const auto outcome = move_j(goal);
  ASSERT_TRUE(outcome.failure.has_value()) << flown->story().text();
  EXPECT_EQ(static_cast<std::uint16_t>(*outcome.failure), 0x8004) << flown->story().text();
  EXPECT_TRUE(flown->story().has("ARM low CONTACT JOINT=turn")) << flown->story().text();
  flown->craft().run(2s);
  EXPECT_LT(apart(told("qd"), Joints{}), 1e-3);
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  EXPECT_TRUE(move_j(goal).completed) << flown->story().text();
}

}  // namespace
}  // namespace hirosco
