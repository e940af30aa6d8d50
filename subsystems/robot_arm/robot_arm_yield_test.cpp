// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Cholesky>

#include "subsystems/robot_arm/testing/flown.hpp"

/// An arm that gives way: reactions to a contact, and soft laws.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using ::testing::EndsWith;
using ::testing::StartsWith;

struct RobotArmYields : ::testing::Test {
  Flown flown{6, std::string{folder} + "robot_arm.urdf"};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});
  std::vector<JointVector> came;
  const std::vector<double> soft{200, 200, 100, 20, 20, 20, 0.7};

  void SetUp() override {
    flown.plant.place(start);
    flown.operate();
  }
  JointVector place() const { return flown.plant.measured().position; }
  std::string asked(const char* function, const std::vector<double>& numbers) {
    const auto request = flown.ask(function, numbers);
    flown.cycle(3);
    return flown.rig.outcome(request);
  }
  std::string react_by(std::uint8_t reaction, double limit = 0.3) {
    const auto request = flown.rig.call_with("SET_CONTACT", {Value{Number{reaction}}, Value{limit}});
    flown.cycle(3);
    return flown.rig.outcome(request);
  }
  /// Somebody is in the way of the first joint of a motion. Its outcome.
  std::string met() {
    const auto motion = flown.move_j(goal, 0.5);
    for (int i = 0; i < 100; ++i) {
      flown.cycle(5);
      came.push_back(place());
    }
    flown.outside[0] = 60;
    for (int i = 0; i < 200 && flown.rig.events(1025) == 0; ++i) flown.cycle();
    flown.cycle();
    return flown.rig.outcome(motion);
  }
};

TEST_F(RobotArmYields, FloatsWithWhoeverIsMetUntilItIsToHold) {
  ASSERT_EQ(react_by(2), "1 3 7");
  EXPECT_EQ(met(), "1 3 8:8004");
  const JointVector where = place();
  flown.outside[0] = 40;
  flown.cycle(600);
  EXPECT_GT(place()[0] - where[0], 0.2) << "it is led";
  EXPECT_EQ(flown.rig.events(1025), 1);
  const auto refused = flown.move_j(goal);
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:800c"));
  flown.outside[0] = 0;
  flown.cycle(1500);
  const JointVector left = place();
  flown.cycle(500);
  EXPECT_LT(flown.off(left), 0.01) << "nobody leads it";
  ASSERT_EQ(asked("HOLD", {}), "1 3 7");
  flown.cycle(500);
  EXPECT_LT(flown.off(left), 0.02);
  const auto next = flown.move_j(goal);
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), "1 3 5:0001 7");
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  EXPECT_LE(flown.largest_share, 1);
}

TEST_F(RobotArmYields, BacksOffByTheWayItCameAndStands) {
  ASSERT_EQ(react_by(3), "1 3 7");
  EXPECT_EQ(met(), "1 3 8:8004");
  const JointVector where = place();
  flown.outside[0] = 0;
  for (int i = 0; i < 300 && flown.rig.events(1027) == 0; ++i) flown.cycle(10);
  EXPECT_EQ(flown.rig.events(1027), 1);
  flown.cycle(500);
  // Where it was before, so far before where it was met.
  double off = HUGE_VAL;
  for (const JointVector& each : came) off = std::min(off, flown.off(each));
  EXPECT_LT(off, 0.01);
  EXPECT_NEAR(flown.off(where), 0.1, 0.03);
  const JointVector there = place();
  flown.cycle(500);
  EXPECT_LT(flown.off(there), 1e-3);
  const auto next = flown.move_j(goal);
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), "1 3 5:0001 7");
}

TEST_F(RobotArmYields, StandsWhenItMeetsSomebodyElseBackingOff) {
  ASSERT_EQ(react_by(3), "1 3 7");
  EXPECT_EQ(met(), "1 3 8:8004");
  flown.outside[0] = 0;
  flown.cycle(150);
  flown.outside[0] = -60;
  flown.cycle(50);
  EXPECT_EQ(flown.rig.events(1025), 2);
  flown.outside[0] = 0;
  flown.cycle(500);
  const JointVector there = place();
  flown.cycle(1000);
  EXPECT_LT(flown.off(there), 1e-3);
  EXPECT_EQ(flown.rig.events(1027), 1);
}

TEST_F(RobotArmYields, WhoIsBeingStoppedIsStoppedWhateverItMeets) {
  ASSERT_EQ(react_by(2), "1 3 7");
  const auto motion = flown.move_j(goal);
  flown.cycle(400);
  const auto stop = flown.rig.call("STOP");
  flown.outside[0] = 80;
  flown.finish(stop);
  EXPECT_EQ(flown.rig.outcome(stop), "1 3 7");
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:0204");
  flown.cycle(3);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
}

TEST_F(RobotArmYields, IsSoftAtItsJointsOrItsToolAndHardAgainWithoutAJump) {
  ASSERT_EQ(react_by(0), "1 3 7");
  for (const auto& [function, numbers] :
       {std::pair{"IMPEDANCE_J", soft}, {"IMPEDANCE_L", std::vector<double>{300, 20, 0.7}}}) {
    ASSERT_EQ(asked(function, numbers), "1 3 7") << function;
    const JointVector where = place();
    flown.outside[0] = 30;
    flown.cycle(1500);
    EXPECT_GT(flown.off(where), 0.1) << function << ": and no limit of following";
    EXPECT_EQ(flown.rig.inhibited(), 0u);
    // Hard where it was pushed to, as long as somebody pushes and afterwards.
    const JointVector commanded = flown.commanded, aside = place();
    ASSERT_EQ(asked("POSITION_CONTROL", {}), "1 3 7");
    EXPECT_LT((flown.commanded - commanded).cwiseAbs().maxCoeff(), 1) << function;
    flown.cycle(1000);
    flown.outside[0] = 0;
    flown.cycle(1000);
    EXPECT_LT(flown.off(aside), 0.01) << function;
    EXPECT_EQ(flown.rig.inhibited(), 0u);
    const auto motion = flown.move_j(start);
    flown.finish(motion);
    EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7") << function;
    EXPECT_LE(flown.off(start), 1e-3);
  }
  EXPECT_LE(flown.largest_share, 1);
}

TEST_F(RobotArmYields, MovesWhileItIsSoftAndIsDoneWithItsPath) {
  ASSERT_EQ(asked("IMPEDANCE_J", soft), "1 3 7");
  const auto motion = flown.move_j(goal, 0.5);
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7");
  flown.cycle(500);
  EXPECT_LT(flown.off(goal), 0.1);
  EXPECT_EQ(flown.rig.events(1025), 0);
}

TEST_F(RobotArmYields, RefusesASpringThatIsTooStiffAndNamesIt) {
  std::vector<double> hard = soft;
  hard[4] = 4000;
  EXPECT_THAT(asked("IMPEDANCE_J", hard), StartsWith("1 4:800b"));
}

/// Somebody leans on a standing arm, which is told, and then it is to move towards him.
TEST_F(RobotArmYields, PressesWhoLeansOnItNoHarderThanItsLimitOnceMoreHoweverOftenItIsToMove) {
  const double effort = flown.model.joints()[0].limits.effort.value(), from = place()[0];
  double most = 0;
  const auto lean = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) {
      flown.outside[0] = 0.4 * effort + 200 * std::max(0.0, from - place()[0]);
      most = std::max(most, flown.outside[0] / effort);
      flown.cycle();
    }
  };
  lean(500);
  ASSERT_EQ(flown.rig.events(1025), 1);
  for (int told = 2; told <= 4; ++told) {
    const auto motion = flown.move_j(goal, 0.5);
    lean(1000);
    EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:8004") << told;
    EXPECT_EQ(flown.rig.events(1025), told);
  }
  EXPECT_LT(most, 0.7);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  // What counts is said anew: who is clamped is let go of.
  ASSERT_EQ(react_by(2), "1 3 7");
  lean(50);
  const auto refused = flown.move_j(goal);
  lean(3);
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:800c"));
}

/// What a joint that the law of positions holds does for a torque d that its model does not have, by the law's three poles at w = BANDWIDTH:
/// error(s) = s / (s + w)^3 d(s), where d is in rad/s2. What makes so much of torques: the inverse of what moves.
struct Reckoned {
  robotics::MassMatrix moved, eased;  ///< kg m2 with rotors, and its inverse

  inline static const robot_arm::Law::Settings settings{};
  inline static const double w = settings.bandwidth_rad_s;

  Reckoned(const Flown& flown, const JointVector& posture) {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = posture, .qd = JointVector::Zero(posture.size())});
    dynamics.mass_matrix(moved);
    moved.diagonal().array() += flown.plant.rotor;
    eased = moved.llt().solve(robotics::MassMatrix::Identity(moved.rows(), moved.cols()));
  }
  /// rad: whatever a torque within `most` does from moment to moment. The response to a step, t^2/2 exp(-w t), goes up and down once by its largest value.
  [[nodiscard]] double farthest(const JointVector& most) const {
    const JointVector pushed = eased.cwiseAbs() * most;
    return pushed.maxCoeff() * 4 * std::exp(-2) / (w * w);
  }
  /// rad/s of the first joint, for a torque that grows by so much in a second: the same response's largest value.
  [[nodiscard]] double fastest(double grows_n_m_s) const {
    return eased(0, 0) * grows_n_m_s * 2 * std::exp(-2) / (w * w);
  }
  /// rad of the first joint for a torque that stands and that its integral may not learn, while all others learn theirs: the law's spring of its own inertia.
  [[nodiscard]] double left_by(double n_m) const { return n_m / (3 * w * w * moved(0, 0)); }
};

/// A load that nobody declared, beyond the limit, and within what the law of positions may learn (`integral_share` of an effort): it is told once, moved with
/// to the goal, and whoever is met besides counts.
TEST_F(RobotArmYields, MovesWithALoadThatNobodyDeclaredAndStopsForWhatComesToIt) {
  const auto& limits = flown.model.joints()[0].limits;
  const double effort = limits.effort.value(), limit = 0.2;
  // Between the two; and of it the limit once more is borne.
  const double share = (limit + Reckoned::settings.integral_share) / 2, load = share * effort;
  ASSERT_EQ(react_by(1, limit), "1 3 7");
  flown.outside[0] = load;
  flown.cycle(500);
  ASSERT_EQ(flown.rig.events(1025), 1);
  const auto motion = flown.move_j(goal, 0.5);
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7");
  const auto next = flown.move_j(start, 0.5);
  flown.cycle(500);
  // What is felt of a step grows with the observer's gain, and has to last for three cycles; what has to come for that within 50, and half as much again.
  const int within = 50;
  const double felt = 1 - std::exp(-robot_arm::OnBoardModel::observer_gain_per_s * 1e-3 * (within - 3));
  flown.outside[0] += 1.5 * (2 * limit - share) * effort / felt;
  flown.cycle(within);
  EXPECT_EQ(flown.rig.outcome(next), "1 3 8:8004");
  EXPECT_EQ(flown.rig.events(1025), 2);
  // From the other side nothing stood there. From one cycle to the next it would make the folded arm as fast as SPEED_LIMIT, which is faster than it is felt and is
  // left to the brakes; it comes so slowly that half of what is left before that limit is enough.
  flown.outside[0] = load;
  flown.cycle(1000);
  const double speed = 0.5, left_rad_s = (robot_arm::Watch::Limits{}.speed_share - speed) * limits.velocity.value();
  const Reckoned folded{flown, goal};
  ASSERT_GT(folded.eased(0, 0), Reckoned(flown, place()).eased(0, 0)) << "it is as easily moved as anywhere on its way";
  const int comes = static_cast<int>(std::ceil(1e3 * folded.fastest(2 * load) / (left_rad_s / 2)));
  const auto last = flown.move_j(goal, speed);
  flown.cycle(350);
  for (int i = 1; i <= comes; ++i) {
    flown.outside[0] = load * (1 - 2.0 * i / comes);
    flown.cycle();
  }
  flown.cycle(within);
  EXPECT_THAT(flown.rig.outcome(last), EndsWith(" 8:8004")) << "half-way or not";
  EXPECT_EQ(flown.rig.events(1025), 3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// What is beyond that too moves with the arm and stops it no more, but it comes as near as it may learn to, which is not within 1 mrad, and says so.
TEST_F(RobotArmYields, MovesWithALoadThatItCannotLearnAndSaysThatItIsNotThere) {
  const double effort = flown.model.joints()[0].limits.effort.value();
  const double learnt = Reckoned::settings.integral_share, share = learnt + 0.05;
  flown.outside[0] = share * effort;
  flown.cycle(500);
  ASSERT_EQ(flown.rig.events(1025), 1);
  const auto motion = flown.move_j(goal, 0.5);
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 8:8001");
  // It may learn its dry friction besides, which may act for the load or against it.
  EXPECT_LT(flown.off(goal), Reckoned(flown, goal).left_by((share - learnt) * effort) + robot_arm::left_alone);
  EXPECT_EQ(flown.rig.events(1025), 1) << "what it carries it did not meet";
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// MASS and PLACE.
const std::vector<double> two_kg{2, 0, 0, 0};

/// The load is there, and was learnt; or it is not, and what was said of it is wrong.
TEST_F(RobotArmYields, TakesALoadThatIsDeclaredWithoutAStepAndStaysWhereItIs) {
  robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
  dynamics.update({.q = start, .qd = JointVector::Zero(6)});
  robotics::Coordinates weight = robotics::Coordinates::Zero(6);
  robot_arm::Law::add_payload({2}, flown.model.find_frame("tool").value(), {0, 0, -9.81}, dynamics,
                              JointVector::Zero(6), weight);
  for (const double hangs : {1.0, 0.0}) {
    Flown arm{6, std::string{folder} + "robot_arm.urdf"};
    arm.plant.place(start);
    arm.operate();
    arm.rig.call_with("SET_CONTACT", {Value{Number{std::uint8_t{0}}}, Value{0.3}});
    arm.outside = -hangs * weight;
    arm.cycle(3000);
    ASSERT_LT(arm.off(start), 1e-3);
    const auto taken = arm.ask("SET_PAYLOAD", two_kg);
    JointVector last = arm.commanded;
    double steepest = 0, farthest = 0;
    for (int i = 0; i < 1000; ++i) {
      arm.cycle();
      for (Eigen::Index j = 0; j < 6; ++j)
        steepest = std::max(steepest, std::abs(arm.commanded[j] - last[j]) /
                                          arm.model.joints()[static_cast<std::size_t>(j)].limits.effort.value());
      last = arm.commanded;
      farthest = std::max(farthest, arm.off(start));
    }
    EXPECT_EQ(arm.rig.outcome(taken), "1 3 7") << hangs;
    EXPECT_LT(steepest, 0.01) << hangs;
    EXPECT_LT(farthest, 3e-3) << hangs;
  }
}

/// Where it is led or held by springs a load that is not there would lift it, and a posture that its drives cannot hold it with is none for it.
TEST_F(RobotArmYields, TakesNoLoadWhileItMovesOrGivesWayNorOneThatItsDrivesCannotHold) {
  EXPECT_THAT(asked("SET_PAYLOAD", {10, 0.5, 0.5, 0.5}), StartsWith("1 4:8005"));
  const auto motion = flown.move_j(goal, 0.5);
  flown.cycle(100);
  EXPECT_THAT(asked("SET_PAYLOAD", two_kg), StartsWith("1 4:0108"));
  flown.finish(motion);
  ASSERT_EQ(asked("IMPEDANCE_J", soft), "1 3 7");
  const JointVector there = place();
  EXPECT_THAT(asked("SET_PAYLOAD", two_kg), StartsWith("1 4:800d"));
  flown.cycle(500);
  EXPECT_LT(flown.off(there), 0.02);
  ASSERT_EQ(asked("POSITION_CONTROL", {}), "1 3 7");
  flown.cycle(200);
  ASSERT_EQ(react_by(2), "1 3 7");
  // Whoever goes on with what it takes to be met has the arm as fast as SPEED_LIMIT: brakes hold it then, and nobody leads it.
  flown.outside[0] = 50;
  for (int i = 0; i < 200 && flown.rig.events(1025) == 0; ++i) flown.cycle();
  const JointVector met_at = place();
  flown.outside[0] = 20;
  flown.cycle(200);
  ASSERT_EQ(flown.rig.inhibited(), 0u);
  EXPECT_GT(flown.off(met_at), 0.05) << "it is led";
  EXPECT_THAT(asked("SET_PAYLOAD", {10, 0, 0, 0}), StartsWith("1 4:800c"));
  flown.outside[0] = 0;
  flown.cycle(1000);
  EXPECT_THAT(asked("SET_PAYLOAD", {10, 0, 0, 0}), StartsWith("1 4:800c")) << "it floats though nobody leads it";
}

TEST_F(RobotArmYields, StandsBeforeItIsLedIntoItself) {
  ASSERT_EQ(react_by(2), "1 3 7");
  EXPECT_EQ(met(), "1 3 8:8004");
  flown.outside[0] = 0;
  flown.outside[2] = 40;
  flown.outside[3] = 8;
  int cycles = 0;
  while (flown.rig.events(1026) == 0 && cycles < 6000) flown.cycle(), ++cycles;
  EXPECT_EQ(flown.rig.events(1026), 1);
  flown.outside = JointVector::Zero(6);
  // The law that it had goes within smooth_s, and what comes of that with three poles at w.
  flown.cycle(static_cast<int>(1e3 * (robot_arm::Laws::smooth_s + 10 / Reckoned::w)));
  // Dry friction, of which the model does not know which way it acts at rest, swings it about where it is to stand while the integral finds out: never farther than
  // so, and ever less. A joint creeps there as in oil, friction / knee thick: s^2 + 3 w^2 H / oil s + w^3 H / oil.
  const Reckoned stands{flown, place()};
  JointVector friction = JointVector::Zero(6);
  double fades_per_s = HUGE_VAL;
  for (Eigen::Index i = 0; i < 6; ++i) {
    friction[i] = flown.model.joints()[static_cast<std::size_t>(i)].friction;
    const double oil = friction[i] / robot_arm::testing::Plant::knee;
    fades_per_s = std::min(fades_per_s, 3 * Reckoned::w * Reckoned::w * stands.moved(i, i) / oil / 2);
  }
  const double swings = stands.farthest(friction) + robot_arm::left_alone;
  constexpr double stands_within = 1e-3;
  std::vector<JointVector> swung;
  for (double t_s = 0; t_s < std::log(swings / (stands_within / 2)) / fades_per_s; t_s += 1e-3) {
    flown.cycle();
    swung.push_back(place());
  }
  const JointVector there = place();
  for (const JointVector& each : swung)
    ASSERT_LT((each - there).cwiseAbs().maxCoeff(), swings + stands_within / 2) << "it does not go away";
  for (int i = 0; i < 3000; ++i) {
    flown.cycle();
    ASSERT_LT(flown.off(there), stands_within) << i;
  }
  EXPECT_EQ(flown.rig.events(1026), 1);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Four slides along one axis: "near" in front of one post of the base, "tool" in front of another, so far apart with all of them at 0.
std::string slides(double near_m, double tool_m) {
  const auto box = [](double x, double y) {
    return "<collision><origin xyz='" + std::to_string(x) + " " + std::to_string(y) +
           " 0'/><geometry><box size='0.1 0.1 0.1'/></geometry></collision>";
  };
  const auto link = [](const std::string& name, const std::string& shapes) {
    return "<link name='" + name +
           "'><inertial><mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' "
           "izz='0.01'/></inertial>" +
           shapes + "</link>";
  };
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name='" + name + "' type='prismatic'><parent link='" + parent + "'/><child link='" + child +
           "'/><axis xyz='1 0 0'/><limit lower='-0.3' upper='0.3' velocity='1' effort='50'/>"
           "<dynamics damping='0.2' friction='0.1'/></joint>";
  };
  return "<robot name='slides'>" + link("base", box(0, 0) + box(0, 1)) + link("one", "") +
         link("near", box(0.1 + near_m, 0)) + link("two", "") + link("tool", box(0.1 + tool_m, 1)) +
         joint("a", "base", "one") + joint("b", "one", "near") + joint("c", "near", "two") + joint("d", "two", "tool") +
         "</robot>";
}

/// Somebody leads the last slide towards its post. How near it came, and what TOO_NEAR said.
struct Led {
  double least_m{HUGE_VAL};
  std::string pair;
};
Led led(const std::string& name, double near_m, double tool_m, const JointVector& from) {
  Flown flown{4, robot_arm::testing::file_with(name, slides(near_m, tool_m))};
  flown.plant.place(from);
  flown.operate();
  const auto float_from_now = flown.rig.call_with("SET_CONTACT", {Value{Number{std::uint8_t{2}}}, Value{0.3}});
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(float_from_now), "1 3 7");
  flown.outside[3] = -18;
  Led found;
  for (int i = 0; i < 1000; ++i) {
    flown.cycle();
    found.least_m = std::min(found.least_m, tool_m + flown.plant.measured().position.sum());
  }
  EXPECT_GE(flown.rig.events(1025), 1) << "it was let go of";
  EXPECT_LE(flown.rig.events(1026), 1) << "and floats no more behind that";
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  const auto told = std::ranges::find(flown.rig.raised, std::uint16_t{1026}, &testing::Raised::id);
  if (told == flown.rig.raised.end()) return found;
  const auto words = std::span{told->auxiliary}.subspan(sizeof(double));
  EXPECT_EQ(words.size(), 64u);
  found.pair = fixed_words(words);
  return found;
}

/// Its limit is a third of 30 mm.
TEST(RobotArmThatIsLed, StandsBeforeTwoMeetThatAreBuiltNearEachOther) {
  const Led found = led("built_near.urdf", 0.2, 0.03, JointVector::Zero(4));
  EXPECT_EQ(found.pair, "base and tool");
  EXPECT_GT(found.least_m, 0.005);
}

/// One pair stands at 12 mm, where the limit is 20: it hides no other that closes from 30.
TEST(RobotArmThatIsLed, StandsBeforeTwoMeetThoughTwoOthersAreNearerAlready) {
  const Led found = led("hidden.urdf", 0.1, 0.2, vector_of(std::array{0.0, -0.088, 0.0, -0.082}));
  EXPECT_EQ(found.pair, "base and tool");
  EXPECT_GT(found.least_m, 0.014);
}

/// What the descriptor leaves out, the arm does not have.
TEST(RobotArmWithoutImpedance, HasNoneWhereItsDescriptorOffersNone) {
  std::string text = robot_arm::testing::descriptor_for(6, std::string{folder} + "robot_arm.urdf");
  for (const char* function : {"IMPEDANCE_J", "IMPEDANCE_L", "POSITION_CONTROL"}) {
    const auto from = text.find(std::string{"<Function name=\""} + function);
    ASSERT_NE(from, std::string::npos);
    const std::string end = "</Function>";
    text.erase(from, text.find(end, from) + end.size() - from);
  }
  robot_arm::testing::replace_all(text, R"(init="1" minimum="0" maximum="3")", R"(init="1" minimum="0" maximum="1")");
  const auto arm = make_robot_arm();
  testing::Rig rig{*arm, text};
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7") << ::testing::PrintToString(rig.explanations);
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
  const auto* contact = rig.descriptor().find_function("SET_CONTACT");
  EXPECT_TRUE(pus::encode_call(*contact, std::vector{1.0, 0.3}));
  EXPECT_FALSE(pus::encode_call(*contact, std::vector{2.0, 0.3}));
}

}  // namespace
}  // namespace hirosco
