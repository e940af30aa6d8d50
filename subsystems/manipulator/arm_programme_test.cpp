// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "subsystems/manipulator/manipulator.hpp"
#include "subsystems/manipulator/testing/free_arm.hpp"

/// What a class derived from Manipulator adds, a programme and a surface, with 1, 2, 6 and 7 joints: legs of all joints, and a distance to
/// which each joint counts.
namespace hirosco {
namespace {

using manipulator::Joints;
using manipulator::Legs;
using manipulator::testing::described_arm;
using manipulator::testing::FreeArm;
using manipulator::testing::home_rad;

constexpr std::size_t tour_legs = 4, leg_with_tool = 2;
constexpr double leg_s = 0.5;
constexpr int leg_cycles = 1000;
constexpr std::uint8_t tour_tool = 3;

/// Where a joint is to be at the end of a leg, from 1: each joint elsewhere than its neighbours, at each end elsewhere than at the last; behind
/// the last one at home.
double tour_rad(std::size_t leg, std::size_t joint) noexcept {
  if (leg == 0 || leg == tour_legs) return home_rad(joint);
  const double away = (0.02 + 0.002 * static_cast<double>(joint)) * static_cast<double>(leg + 1);
  return home_rad(joint) + ((leg + joint) % 2 == 0 ? away : -away);
}
std::vector<double> tour_posture(std::size_t leg, std::size_t joints) {
  std::vector<double> posture;
  for (std::size_t i = 0; i < joints; ++i) posture.push_back(tour_rad(leg, i));
  return posture;
}

/// From posture to posture, and holds its tool at the end of one.
class Tour final : public manipulator::Programme {
 public:
  void start(std::size_t joints) noexcept {
    legs_.clear();
    for (std::size_t leg = 0; leg <= tour_legs; ++leg) {
      ends_[leg] = Joints::zeros(joints);
      for (std::size_t i = 0; i < joints; ++i) ends_[leg][i] = tour_rad(leg, i);
      if (leg == 0) continue;
      legs_.add({.duration_s = leg_s, .tool = leg == leg_with_tool ? std::optional{tour_tool} : std::nullopt});
    }
  }
  Joints advance(double span_s) noexcept override {
    if (legs_.done()) return goal_rad();
    const auto [leg, share] = legs_.advance(span_s);
    Joints at = ends_[leg];
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += share * (ends_[leg + 1][i] - at[i]);
    return at;
  }
  [[nodiscard]] std::optional<std::uint8_t> tool() const noexcept override { return legs_.tool(); }
  void tool_done() noexcept override { legs_.tool_done(); }
  [[nodiscard]] bool done() const noexcept override { return legs_.done(); }
  [[nodiscard]] std::size_t leg() const noexcept override { return legs_.leg(); }
  [[nodiscard]] Joints goal_rad() const noexcept override { return ends_[tour_legs]; }

 private:
  Legs legs_;
  std::array<Joints, tour_legs + 1> ends_{};
};

/// A wall that each joint brings nearer as it turns, from home on, by as much as each other.
class Wall final : public manipulator::Surface {
 public:
  static constexpr double lever_m = 0.5, at_home_m = 0.10;
  [[nodiscard]] double gap_m(const Joints& position_rad) const noexcept override {
    double gap = at_home_m;
    for (std::size_t i = 0; i < position_rad.size(); ++i) gap -= lever_m * (position_rad[i] - home_rad(i));
    return gap;
  }
};

/// An arm of whatever shape its surface says, that goes on its tour when it is told to.
class TouringArm final : public Manipulator {
 public:
  explicit TouringArm(std::unique_ptr<const manipulator::Surface> surface) : Manipulator{std::move(surface)} {}
  using Manipulator::desired_rad;

 private:
  void declare() override {
    on_function("TOUR", [this](Call call) -> Outcome {
      if (!moving()) return refused(Trouble::actuators_inhibited);
      if (busy()) return refused(pus::FailureCode::Busy);
      tour_.start(joints());
      return run(tour_, call);
    });
  }
  Tour tour_;
};

std::string touring_arm(std::size_t joints) {
  std::string text = described_arm(joints);
  const std::string home = R"(<Function name="HOME" states="Operational"/>)";
  return text.insert(text.find(home), R"(<Function name="TOUR" states="Operational"/>)");
}

enum class Around : std::uint8_t { Nothing, AWall };

struct DerivedArm : FreeArm {
  DerivedArm(std::size_t joints, Around around)
      : FreeArm{std::make_unique<TouringArm>(around == Around::AWall ? std::make_unique<const Wall>() : nullptr),
                joints, touring_arm(joints)} {
    grips = true;
  }
  [[nodiscard]] Joints desired_rad() const { return static_cast<const TouringArm&>(*arm).desired_rad(); }
  [[nodiscard]] double desired_gap_m() const { return Wall{}.gap_m(desired_rad()); }
};

struct ArmProgrammeTest : ::testing::TestWithParam<std::size_t>, DerivedArm {
  ArmProgrammeTest() : DerivedArm{GetParam(), Around::Nothing} {}
};

TEST_P(ArmProgrammeTest, GoesByItsLegsWithAllJointsAndReportsEachAsAStep) {
  constexpr int around_an_end = 30;
  constexpr double near_rad = 0.01;
  operate();
  const auto tour = rig.call("TOUR");
  std::string outcome = "1 3";
  cycle(leg_cycles - around_an_end);
  for (std::size_t leg = 1; leg < tour_legs; ++leg) {
    EXPECT_EQ(rig.outcome(tour), outcome) << "on leg " << leg;
    cycle(2 * around_an_end);
    outcome += " 5:000" + std::to_string(leg);
    EXPECT_EQ(rig.outcome(tour), outcome);
    EXPECT_EQ(tool, leg < leg_with_tool ? 0 : tour_tool) << "on leg " << leg + 1;
    SCOPED_TRACE("at the end of leg " + std::to_string(leg));
    expect_at(tour_posture(leg, n), near_rad);
    cycle(leg_cycles - 2 * around_an_end);
  }
  EXPECT_EQ(rig.outcome(tour), outcome);
  cycle(leg_cycles);
  EXPECT_EQ(rig.outcome(tour), outcome + " 7");
  EXPECT_EQ(rig.events(1001), 1);
  expect_at(tour_posture(tour_legs, n), 0.005);
}

TEST_P(ArmProgrammeTest, IsNotDoneWhileItsLastJointIsElsewhere) {
  operate();
  load_n_m[n - 1] = 10;  // 33 mrad of its stiffness
  const auto tour = rig.call("TOUR");
  cycle(static_cast<int>(tour_legs) * leg_cycles + leg_cycles);
  EXPECT_EQ(rig.outcome(tour), "1 3 5:0001 5:0002 5:0003");
  cycle(2 * leg_cycles);
  EXPECT_EQ(rig.outcome(tour), "1 3 5:0001 5:0002 5:0003 8:8001");
  EXPECT_EQ(rig.events(1001), 0);
}

TEST_P(ArmProgrammeTest, StandsWithAllJointsWhereHoldFoundItAndIsFreeForAMotion) {
  operate();
  const auto tour = rig.call("TOUR");
  cycle(leg_cycles + leg_cycles / 2);
  const auto refused = rig.call("TOUR");
  cycle(3);
  EXPECT_EQ(rig.outcome(refused), "1 4:0108") << "one at a time";
  const auto hold = rig.call("HOLD");
  cycle(3);
  EXPECT_EQ(rig.outcome(hold), "1 3 7");
  EXPECT_EQ(rig.outcome(tour), "1 3 5:0001 8:0204");
  cycle(leg_cycles);
  const auto where = position_rad;
  for (std::size_t i = 0; i < n; ++i) {
    const double from = tour_rad(1, i), to = tour_rad(2, i);
    EXPECT_NEAR(where[i], (from + to) / 2, std::abs(to - from) / 4) << "joint " << i + 1;
  }
  cycle(2 * leg_cycles);
  expect_at(where, 1e-4);
  const auto move = move_to(tour_posture(0, n), 1.0);
  cycle(3 * leg_cycles);
  EXPECT_EQ(rig.outcome(move), "1 3 5:0001 7");
  expect_at(tour_posture(0, n), 0.005);
}

/// Of 50 mrad that are asked for at once, 3.5 in 10 ms and a grain.
TEST_P(ArmProgrammeTest, LeadsNoJointFasterThanItMayWhateverIsAsked) {
  constexpr double jump_rad = 0.05;
  operate(2);
  for (std::size_t i = 0; i < n; ++i) {
    const double from_rad = desired_rad()[i];
    handle_rad[i] = jump_rad;
    cycle(20);
    EXPECT_LT(desired_rad()[i] - from_rad, 0.006) << "joint " << i + 1;
    cycle(leg_cycles);
    EXPECT_NEAR(desired_rad()[i] - from_rad, jump_rad, 1e-3) << "joint " << i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, ArmProgrammeTest, ::testing::Values(1, 2, 6, 7));

struct ArmSurfaceTest : ::testing::TestWithParam<std::size_t> {
  static constexpr double far_rad = 0.3;  // the wall is two thirds of the way there

  struct Meeting {
    double fastest_m_s{0};  ///< of the setpoint, behind the wall
    double late_rad{0};  ///< of the setpoint, when its path has ended
    std::string outcome;
  };
  /// Moves these joints together by `far_rad` in all, at nearly full speed.
  static Meeting meet(std::size_t joints, const std::vector<std::size_t>& moved, Around around) {
    constexpr double duration_s = 0.6;
    constexpr int path_cycles = 1200;
    // Behind the wall. The setpoint that the law is given is ahead of the one that is governed, by a grain of each joint.
    const double grain_m = Wall::lever_m * manipulator::SetpointGovernor::grain_rad;
    const double from_m = -0.001 - grain_m * static_cast<double>(moved.size()), to_m = -0.04;
    DerivedArm flown{joints, around};
    flown.operate();
    auto goal = flown.position_rad;
    for (const std::size_t joint : moved) goal[joint] += far_rad / static_cast<double>(moved.size());
    const auto move = flown.move_to(goal, duration_s);
    Meeting meeting;
    double before_m = flown.desired_gap_m();
    for (int i = 0; i < 3 * path_cycles; ++i) {
      flown.cycle();
      const double now_m = flown.desired_gap_m();
      if (now_m < from_m && now_m > to_m)
        meeting.fastest_m_s = std::max(meeting.fastest_m_s, (before_m - now_m) / FreeArm::cycle_s);
      if (i == path_cycles) meeting.late_rad = (now_m - (Wall::at_home_m - Wall::lever_m * far_rad)) / Wall::lever_m;
      before_m = now_m;
    }
    meeting.outcome = flown.rig.outcome(move);
    flown.expect_at(goal, 0.006);  // it stands where it was found within 5 mrad
    return meeting;
  }
};

TEST_P(ArmSurfaceTest, HoldsTheSetpointBackWhicheverJointsComeNearToIt) {
  constexpr double contact_m_s = 0.060;
  const std::size_t n = GetParam();
  std::vector<std::vector<std::size_t>> motions(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    motions[i] = {i};
    motions[n].push_back(i);
  }
  for (const auto& moved : motions) {
    SCOPED_TRACE(moved.size() == 1 ? "joint " + std::to_string(moved[0] + 1) : "all joints");
    const Meeting free = meet(n, moved, Around::Nothing), held = meet(n, moved, Around::AWall);
    EXPECT_GT(free.fastest_m_s, 4 * contact_m_s) << "so it would come there";
    EXPECT_LT(free.late_rad, 0.005);
    EXPECT_LT(held.fastest_m_s, 1.01 * contact_m_s);
    EXPECT_GT(held.fastest_m_s, 0.9 * contact_m_s) << "it goes on";
    EXPECT_GT(held.late_rad, 0.05);
    EXPECT_EQ(held.outcome, "1 3 5:0001 7") << "and arrives";
  }
}

TEST_P(ArmSurfaceTest, LetsGoWhoLeavesIt) {
  DerivedArm flown{GetParam(), Around::AWall};
  for (double& position : flown.position_rad) position += 0.3 / static_cast<double>(flown.n);  // behind it
  flown.operate();
  ASSERT_LT(flown.desired_gap_m(), 0);
  const auto home = tour_posture(0, flown.n);
  const auto move = flown.move_to(home, 0.6);
  flown.cycle(1220);
  EXPECT_NEAR(flown.desired_gap_m(), Wall::at_home_m, 1e-3) << "on time";
  flown.cycle(400);
  EXPECT_EQ(flown.rig.outcome(move), "1 3 5:0001 7");
}

INSTANTIATE_TEST_SUITE_P(Joints, ArmSurfaceTest, ::testing::Values(1, 2, 6, 7));

}  // namespace
}  // namespace hirosco
