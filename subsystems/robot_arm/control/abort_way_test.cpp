// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/abort_way.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "subsystems/robot_arm/control/trail.hpp"

namespace hirosco::robot_arm {
namespace {

using ::testing::StrEq;

[[nodiscard]] JointVector at(double one, double other) { return vector_of(std::array{one, other}); }

/// Of two joints, with something in the way wherever a test says so.
struct AbortWayTest : ::testing::Test {
  using Found = AbortWay::Found;
  using Judged = AbortWay::Judged;
  AbortWay way;
  std::function<const char*(const JointVector&)> in_the_way = [](const JointVector&) { return ""; };
  std::vector<JointVector> looked_at;
  std::vector<bool> by_itself;  ///< of each of them
  double widest{0};
  std::size_t most_looks{10'000};
  std::vector<double> progress;  ///< behind each look

  Found judge(const std::vector<JointVector>& postures, const JointVector& here, Judged what = Judged::FromHere) {
    way.begin(postures, here, what, most_looks);
    looked_at.clear();
    progress.clear();
    by_itself.clear();
    widest = 0;
    for (int cycle = 0; cycle < 10'000 && way.found() == Found::NotYet; ++cycle) {
      looked_at.push_back(way.then());
      by_itself.push_back(way.by_itself());
      if (what == Judged::FromHere) widest = std::max(widest, apart(way.before(), way.then()));
      const std::string name = in_the_way(way.then());
      way.heed(name.empty() ? robotics::Clearance::Nearest{} : robotics::Clearance::Nearest{0.01, wall});
      progress.push_back(way.progress());
    }
    return way.found();
  }
  [[nodiscard]] bool looked_at_about(const JointVector& where) const {
    for (const JointVector& each : looked_at)
      if (apart(each, where) < AbortWay::spacing) return true;
    return false;
  }
  static constexpr const char* wall = "hand and a volume to keep out of";
  /// Nothing stands with its first joint between these.
  void wall_between(double low, double high) {
    in_the_way = [low, high](const JointVector& where) { return where[0] > low && where[0] < high ? wall : ""; };
  }
};

TEST_F(AbortWayTest, BeginsWithTheNearestPostureWhenAllIsFree) {
  const std::vector path{at(1, 0), at(0.5, 0), at(0.5, 1)};
  ASSERT_EQ(judge(path, at(0.4, -0.1)), Found::Way);
  EXPECT_EQ(way.joined(), 1u);
  EXPECT_LE(widest, AbortWay::spacing + 1e-12) << "nothing wider lies between two looks";
  for (const JointVector& where : {at(0.75, 0), at(0.5, 0.5), at(0.45, -0.05), at(0.5, 1)})
    EXPECT_TRUE(looked_at_about(where)) << where.transpose();
  EXPECT_LE(looked_at.size(), 90u) << "a posture in a cycle, and no way twice";
}

TEST_F(AbortWayTest, GoesToTheNextNearestPostureWhereSomethingIsInTheWayToTheNearest) {
  const std::vector path{at(-0.8, 0), at(-0.8, 1), at(0.4, 1), at(0.4, 0)};
  in_the_way = [](const JointVector& where) { return where[0] > 0.1 && where[0] < 0.3 && where[1] < 0.5 ? wall : ""; };
  ASSERT_EQ(judge(path, at(0, 0)), Found::Way);
  EXPECT_EQ(way.joined(), 0u) << "the last one is nearer, and behind a wall";
}

TEST_F(AbortWayTest, IsJoinedBehindWhatStandsInItsMiddle) {
  const std::vector path{at(0.1, 0), at(1, 0), at(-1, 1)};
  wall_between(0.4, 0.6);
  ASSERT_EQ(judge(path, at(0, 0)), Found::Way);
  EXPECT_EQ(way.joined(), 2u) << "who went to the first one could go no farther";
}

TEST_F(AbortWayTest, ThatNobodyCanJoinTellsWhoIsInTheWayToTheNearestPosture) {
  const std::vector path{at(1.5, 0), at(1, 0)};
  wall_between(0.4, 0.6);
  ASSERT_EQ(judge(path, at(0, 0)), Found::Nothing);
  EXPECT_THAT(way.in_the_way().names, StrEq(wall));
  EXPECT_EQ(way.in_the_way().distance_m, 0.01);
  EXPECT_EQ(way.blocked(), 1u);
  EXPECT_TRUE(looked_at_about(at(0.4, 0)));
}

TEST_F(AbortWayTest, OfOnePostureIsTheWayToIt) {
  ASSERT_EQ(judge({at(1, 0)}, at(0, 0)), Found::Way);
  EXPECT_EQ(way.joined(), 0u);
  EXPECT_EQ(looked_at.size(), 1u + 50u) << "the posture itself, and the way";
  ASSERT_EQ(judge({at(1, 0)}, at(1, 0)), Found::Way);
  EXPECT_EQ(looked_at.size(), 2u) << "it stands there";
}

TEST_F(AbortWayTest, IsLookedAtByItselfWhereItIsStoredAndByWhatTheArmIsNearAlreadyOnTheWayThere) {
  ASSERT_EQ(judge({at(0.1, 0), at(0.2, 0)}, at(0, 0)), Found::Way);
  ASSERT_FALSE(by_itself.empty());
  for (std::size_t i = 0; i < looked_at.size(); ++i)
    EXPECT_EQ(by_itself[i], i < 6) << "two postures and what lies between them: " << looked_at[i].transpose();
  EXPECT_EQ(judge({at(0.1, 0), at(0.2, 0)}, at(0, 0), Judged::PathAlone), Found::Way);
  EXPECT_THAT(by_itself, ::testing::Each(true));
}

TEST_F(AbortWayTest, WhoseLastPostureIsInTheWayLeadsNowhere) {
  wall_between(0.9, 1.1);
  for (const auto what : {Judged::FromHere, Judged::PathAlone}) {
    EXPECT_EQ(judge({at(0.5, 0), at(1, 0)}, at(0, 0), what), Found::Nothing);
    EXPECT_EQ(way.blocked(), 1u);
    EXPECT_EQ(looked_at.size(), 1u) << "nothing of it is free";
  }
}

TEST_F(AbortWayTest, OfEightPosturesIsJudgedWhole) {
  std::vector<JointVector> path;
  for (int i = 0; i < 8; ++i) path.push_back(at(0.1 * i, 0));
  ASSERT_EQ(judge(path, at(-0.1, 0)), Found::Way);
  EXPECT_EQ(way.joined(), 0u);
  EXPECT_EQ(way.size(), 8u);
}

TEST_F(AbortWayTest, JudgedAloneIsFreeFromItsFirstPostureToItsLastOrNotAtAll) {
  const std::vector path{at(0, 0), at(1, 0), at(1, 1)};
  EXPECT_EQ(judge(path, at(-3, 0), Judged::PathAlone), Found::Way);
  EXPECT_FALSE(looked_at_about(at(-1, 0))) << "nobody goes there";
  wall_between(0.4, 0.6);
  EXPECT_EQ(judge(path, at(3, 0), Judged::PathAlone), Found::Nothing);
  EXPECT_EQ(way.blocked(), 1u) << "on the way to the second";
  wall_between(-0.1, 0.01);
  EXPECT_EQ(judge(path, at(3, 0), Judged::PathAlone), Found::Nothing);
  EXPECT_EQ(way.blocked(), 0u) << "the first one itself";
}

/// A posture, a radian to the next and a radian to another: 101 looks.
TEST_F(AbortWayTest, ThatTakesMoreLooksThanItMayIsNotJudgedAtAll) {
  const std::vector path{at(0, 0), at(1, 0), at(1, 1)};
  most_looks = 101;
  EXPECT_EQ(judge(path, at(-3, 0), Judged::PathAlone), Found::Way);
  EXPECT_EQ(looked_at.size(), most_looks);
  most_looks = 100;
  EXPECT_EQ(judge(path, at(-3, 0), Judged::PathAlone), Found::TooLong);
  EXPECT_TRUE(looked_at.empty()) << "it is known before";
  EXPECT_EQ(way.progress(), 1);
  most_looks = 200;
  EXPECT_EQ(judge(path, at(-3, 0)), Found::TooLong) << "150 more are the way to the nearest";
}

/// 176 looks are the path, 25 the way to its nearest posture, which is blocked at the sixth, and 50 that to the next nearest.
TEST_F(AbortWayTest, IsGivenUpWhereTheNextWayToItTakesMoreThanWhatIsLeft) {
  const std::vector path{at(-1, 0), at(-1, 1), at(0.5, 1), at(0.5, 0)};
  in_the_way = [](const JointVector& where) { return where[0] > 0.1 && where[0] < 0.3 && where[1] < 0.5 ? wall : ""; };
  most_looks = 176 + 25 - 1;
  EXPECT_EQ(judge(path, at(0, 0)), Found::TooLong);
  EXPECT_TRUE(looked_at.empty());
  most_looks = 176 + 6 + 50 - 1;
  EXPECT_EQ(judge(path, at(0, 0)), Found::TooLong) << "whoever was in the way of the nearest";
  EXPECT_EQ(looked_at.size(), 176u + 6u);
  most_looks = 176 + 6 + 50;
  EXPECT_EQ(judge(path, at(0, 0)), Found::Way);
  EXPECT_EQ(way.joined(), 0u);
  EXPECT_EQ(looked_at.size(), most_looks);
}

TEST_F(AbortWayTest, TellsHowMuchOfWhatThereMayBeWasLookedAt) {
  const std::vector path{at(1, 0), at(0.5, 0)};
  ASSERT_EQ(judge(path, at(0, 0)), Found::Way);
  ASSERT_EQ(progress.size(), 51u);
  EXPECT_TRUE(std::ranges::is_sorted(progress));
  EXPECT_NEAR(progress[25], 26.0 / (26 + 25 + 50), 1e-12) << "the path, and the way to either of its postures";
  EXPECT_EQ(progress.back(), 1);
}

TEST_F(AbortWayTest, ToWhereNobodyComesIsNotJudged) {
  EXPECT_EQ(judge({at(0, 0), at(HUGE_VAL, 0)}, at(0, 0), Judged::PathAlone), Found::TooLong);
}

TEST_F(AbortWayTest, OfNoPostureIsNone) { EXPECT_EQ(judge({}, at(0, 0)), Found::Nothing); }

}  // namespace
}  // namespace hirosco::robot_arm
