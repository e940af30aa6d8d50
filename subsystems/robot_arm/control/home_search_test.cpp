// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "subsystems/robot_arm/control/home_search.hpp"

namespace hirosco::robot_arm {
namespace {

using End = HomeSearch::End;

/// Three joints that go exactly where they are to be, with marks; what they tell is ahead of where they are until they know their zero.
struct HomeSearchTest : ::testing::Test {
  static constexpr double cycle_s = 0.001;
  HomeSearch search{cycle_s};
  std::array<double, 3> at{0.3, -0.2, 0.1}, ahead{1, -2, 0.5}, mark{0.4, -0.3, 0.2};
  std::array<std::uint8_t, 3> referenced{};
  std::array<HomeSearch::Way, 3> ways{{{0.1, 0.2}, {-0.1, 0.2}, {0.1, 0.2}}};
  std::array<std::uint8_t, 3> order{2, 0, 1};
  std::optional<std::size_t> presses;
  Measured measured;
  std::vector<std::size_t> found;

  HomeSearchTest() {
    measure({});
    search.begin({measured, referenced});
  }
  void measure(const std::array<double, 3>& speeds) {
    measured = {JointVector::Zero(3), vector_of(speeds), JointVector::Zero(3)};
    for (std::size_t i = 0; i < 3; ++i) measured.position[static_cast<Eigen::Index>(i)] = at.at(i) - ahead.at(i);
  }
  HomeSearch::News cycle() {
    const HomeSearch::News news = search.advance({measured, referenced, presses});
    if (news.found != 0) found.push_back(news.found);
    const auto looking = search.looking();
    std::array<double, 3> speeds{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double before = at.at(i);
      at.at(i) = search.now().position[k] + ahead.at(i);
      speeds.at(i) = search.now().velocity[k];
      if (looking == i && (before - mark.at(i)) * (at.at(i) - mark.at(i)) <= 0) referenced.at(i) = 1, ahead.at(i) = 0;
    }
    measure(speeds);
    return news;
  }
  HomeSearch::News until_it_ends(int most = 20'000) {
    for (int i = 0; i < most; ++i)
      if (const auto news = cycle(); news.end != End::None) return news;
    return {};
  }
};

TEST_F(HomeSearchTest, LeadsEachJointToItsMarkInTheOrderThatIsSaid) {
  search.look(order, ways);
  std::vector<std::size_t> looked;
  HomeSearch::News news;
  for (int i = 0; i < 20'000 && news.end == End::None; ++i) {
    news = cycle();
    const auto looking = search.looking();
    if (looking && (looked.empty() || looked.back() != *looking)) looked.push_back(*looking);
    int moving = 0;
    for (Eigen::Index joint = 0; joint < 3; ++joint) moving += search.now().velocity[joint] != 0 ? 1 : 0;
    ASSERT_LE(moving, 1);
    ASSERT_LE(search.now().velocity.cwiseAbs().maxCoeff(), 0.1 + 1e-12);
  }
  EXPECT_EQ(news.end, End::Done);
  EXPECT_EQ(looked, (std::vector<std::size_t>{2, 0, 1}));
  EXPECT_EQ(found, (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_TRUE(search.at_rest());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(at.at(i), mark.at(i), 0.02) << i;
}

/// What is told jumps by up to 2 rad; where a joint is goes on.
TEST_F(HomeSearchTest, GoesOnSmoothlyWhereWhatIsToldJumps) {
  search.look(order, ways);
  std::array<double, 3> before = at;
  HomeSearch::News news;
  for (int i = 0; i < 20'000 && news.end == End::None; ++i) {
    news = cycle();
    for (std::size_t joint = 0; joint < 3; ++joint)
      ASSERT_LE(std::abs(at.at(joint) - before.at(joint)), 1.01 * 0.1 * cycle_s) << joint;
    before = at;
  }
  EXPECT_EQ(news.end, End::Done);
}

TEST_F(HomeSearchTest, PassesOverThoseThatKnowTheirZero) {
  referenced = {1, 0, 1};
  ahead = {0, -2, 0};
  measure({});
  search.begin({measured, referenced});
  search.look(order, ways);
  EXPECT_EQ(until_it_ends().end, End::Done);
  EXPECT_EQ(found, (std::vector<std::size_t>{1}));
  search.look(order, ways);
  EXPECT_EQ(cycle().end, End::Done) << "nobody is left";
}

TEST_F(HomeSearchTest, GoesNoFartherThanItsDistanceAndSaysWhoHasNoMark) {
  mark[0] = 5;
  const double began_at = at[0];
  search.look(order, ways);
  const auto news = until_it_ends();
  EXPECT_EQ(news.end, End::NotFound);
  EXPECT_EQ(news.joint, 0U);
  EXPECT_FALSE(search.looking());
  EXPECT_FALSE(search.at_rest());
  for (int i = 0; i < 300; ++i) EXPECT_EQ(cycle().end, End::None) << "told once";
  EXPECT_TRUE(search.at_rest());
  EXPECT_NEAR(at[0] - began_at, 0.2, 1e-3);
  EXPECT_LE(at[0] - began_at, 0.2 + 1e-9) << "what it takes to come to rest is in it";
}

TEST_F(HomeSearchTest, TakesAMarkOnWhichItStandsAndOneAtTheEndOfItsDistance) {
  mark = {at[0] + 0.2 - 0.0126, -0.3, at[2]};
  search.look(order, ways);
  EXPECT_EQ(until_it_ends().end, End::Done);
  EXPECT_EQ(found, (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_NEAR(at[2], mark[2], 1e-3);
}

TEST_F(HomeSearchTest, EndsWhereAJointLosesItsZeroBeforeItHasComeToRestAtItsMark) {
  search.look(order, ways);
  for (int i = 0; i < 20'000 && referenced[2] == 0; ++i) cycle();
  for (int i = 0; i < 10; ++i) cycle();
  const double went_through = at[2];
  referenced[2] = 0;
  ahead[2] = -1;
  measure({0, 0, 0.1});
  const auto news = cycle();
  EXPECT_EQ(news.end, End::Lost);
  EXPECT_EQ(news.joint, 2U);
  for (int i = 0; i < 300; ++i) cycle();
  EXPECT_TRUE(search.at_rest());
  EXPECT_TRUE(found.empty());
  EXPECT_NEAR(at[2], went_through, 0.0126);
}

TEST_F(HomeSearchTest, StandsWhereItIsWhenSomethingIsInTheWay) {
  search.look(order, ways);
  for (int i = 0; i < 500; ++i) cycle();
  presses = 2;
  const JointVector there = measured.position;
  const auto news = cycle();
  EXPECT_EQ(news.end, End::Presses);
  EXPECT_EQ(news.joint, 2U);
  EXPECT_EQ(search.now().position, there);
  at[2] -= 0.01;
  measure({});
  const JointVector pushed_to = measured.position;
  EXPECT_EQ(cycle().end, End::None) << "nobody looks any more";
  EXPECT_EQ(search.now().position, pushed_to);
  EXPECT_FALSE(search.at_rest());
  for (int i = 0; i < 250; ++i) cycle();
  EXPECT_TRUE(search.at_rest());
  at[2] -= 0.01;
  measure({});
  cycle();
  EXPECT_EQ(search.now().position, pushed_to) << "and then it stands";
}

TEST_F(HomeSearchTest, EndsWhereAJointLosesItsZeroAndKeepsItsPlace) {
  search.look(order, ways);
  for (int i = 0; i < 20'000 && search.looking() != 0U; ++i) cycle();
  for (int i = 0; i < 300; ++i) cycle();
  referenced[2] = 0;
  ahead[2] = 2.5;
  measure({0.1, 0, 0});
  const double stood = at[2];
  const auto news = cycle();
  EXPECT_EQ(news.end, End::Lost);
  EXPECT_EQ(news.joint, 2U);
  EXPECT_NEAR(at[2], stood, 1e-9);
}

TEST_F(HomeSearchTest, ComesToRestWhenItIsStoppedAndGoesOnFromThereWhenItIsAskedAgain) {
  search.look(order, ways);
  for (int i = 0; i < 500; ++i) cycle();
  search.stop();
  EXPECT_FALSE(search.looking());
  for (int i = 0; i < 300; ++i) EXPECT_EQ(cycle().end, End::None);
  EXPECT_TRUE(search.at_rest());
  search.look(order, ways);
  EXPECT_EQ(until_it_ends().end, End::Done);
  EXPECT_EQ(found, (std::vector<std::size_t>{1, 2, 3}));
}

}  // namespace
}  // namespace hirosco::robot_arm
