// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/floating/float_law.hpp"
#include "subsystems/robot_arm/testing/free_plant.hpp"

/// What acts on an arm whose base gives way, and what it does about it (docs/adr/0222): on a craft that nothing holds, with closed forms.
namespace hirosco {
namespace {

using robot_arm::FloatingModel;
using robot_arm::JointVector;
using robot_arm::MomentumObserver;
using robot_arm::vector_of;
using robot_arm::testing::FreePlant;
using ::testing::EndsWith;
using ::testing::Not;
using ::testing::StartsWith;

const std::string servicers_file = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf";
const JointVector ready_posture = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});

/// The observer over so many milliseconds, beside a plant that is driven so.
struct FloatingObserver : ::testing::Test {
  robotics::Model model = robot_arm::testing::model_of(servicers_file);
  FreePlant plant{model};
  FloatingModel known{model, model.find_frame("tool").value()};
  MomentumObserver observer{7, 0.001, 50};

  void observe(int cycles, const JointVector& drive) {
    for (int i = 0; i < cycles; ++i) {
      plant.step(drive, 0.001);
      ASSERT_TRUE(known.update(plant.base(), plant.measured().position));
      observer.update(plant.measured(), known.inertia(), known.bias(plant.measured().velocity), JointVector::Zero(7));
    }
  }
};

/// As joints feel it when the base gives way: by the Jacobian of a robot without momentum.
TEST_F(FloatingObserver, FeelsAPushAtTheToolAsJointsOfAFreeCraftDo) {
  plant.place(ready_posture);
  plant.push_n = {2, -1, 1.5};
  ASSERT_NO_FATAL_FAILURE(observe(150, JointVector::Zero(7)));
  const JointVector expected = known.tool_of_free().bottomRows<3>().transpose() * plant.push_n;
  EXPECT_LT((observer.external() - expected).norm(), 0.05 * expected.norm());
  const JointVector of_standing = known.tool_of_fixed().bottomRows<3>().transpose() * plant.push_n;
  EXPECT_GT((observer.external() - of_standing).norm(), 0.3 * of_standing.norm()) << "on a base that stands: another";
}

TEST_F(FloatingObserver, FeelsNothingOfDrivesAndVelocities) {
  plant.place(ready_posture);
  const JointVector drive = vector_of(std::array{1.0, -4.0, 1.0, 2.0, 0.05, -0.06, 0.002});
  ASSERT_NO_FATAL_FAILURE(observe(600, drive));
  EXPECT_GT(plant.measured().velocity.cwiseAbs().maxCoeff(), 0.05);
  EXPECT_LT(observer.external().cwiseAbs().maxCoeff(), 0.02 * drive.cwiseAbs().maxCoeff());
}

/// Cycles in the law of an arm that floats, of whose joints some are pushed besides.
struct FloatingLaw : FloatingObserver {
  std::vector<robot_arm::JointBounds> bounds = robot_arm::testing::bounds_of(model);
  robot_arm::FloatAims aims;
  double farthest{-HUGE_VAL};  ///< that the fore roll has been

  void begin(const JointVector& posture) {
    plant.place(posture);
    ASSERT_TRUE(known.update(plant.base(), posture));
    aims.let_go();
    farthest = -HUGE_VAL;
  }
  void led(int cycles, const JointVector& push) {
    for (int i = 0; i < cycles; ++i) {
      aims.remember(plant.measured().position);
      const auto aim = [&](Eigen::Index joint) { return aims.of(joint); };
      const JointVector walls = robot_arm::wall_torque(known, plant.measured(), aim, bounds, 80);
      const JointVector drive = robot_arm::float_torque(known, plant.measured(), walls, bounds, 5) + push;
      ASSERT_NO_FATAL_FAILURE(observe(1, drive));
      farthest = std::max(farthest, plant.measured().position[4]);
    }
  }
  [[nodiscard]] static JointVector at_fore_roll(double value) {
    JointVector numbers = JointVector::Zero(7);
    numbers[4] = value;
    return numbers;
  }
};

TEST_F(FloatingLaw, StandsBeforeTheEndOfARangeHoweverLongItIsPushedThere) {
  const double highest = bounds[4].highest;
  JointVector posture = ready_posture;
  posture[4] = highest - 0.4;
  ASSERT_NO_FATAL_FAILURE(begin(posture));
  ASSERT_NO_FATAL_FAILURE(led(8000, at_fore_roll(2)));
  EXPECT_LT(farthest, highest - 0.01);
  EXPECT_GT(farthest, highest - 0.4 + 0.01) << "it was led there";
  EXPECT_LT(plant.measured().velocity.cwiseAbs().maxCoeff(), 1e-2);
}

TEST_F(FloatingLaw, IsNotThrownWhereItIsLetGoNearTheEndOfARange) {
  JointVector posture = ready_posture;
  posture[4] = bounds[4].highest - 0.02;
  ASSERT_NO_FATAL_FAILURE(begin(posture));
  ASSERT_NO_FATAL_FAILURE(led(1000, JointVector::Zero(7)));
  EXPECT_LT((plant.measured().position - posture).cwiseAbs().maxCoeff(), 1e-9);
}

/// Nothing of it drives: energy goes, whatever was led.
TEST_F(FloatingLaw, TakesEnergyOnly) {
  ASSERT_NO_FATAL_FAILURE(begin(ready_posture));
  ASSERT_NO_FATAL_FAILURE(observe(300, vector_of(std::array{0.5, -2.0, 1.0, 1.0, 0.3, -0.3, 0.01})));
  const auto energy = [&] {
    const JointVector& rates = plant.measured().velocity;
    return 0.5 * rates.dot(known.inertia() * rates);
  };
  double before = energy();
  EXPECT_GT(before, 1e-3);
  for (int i = 0; i < 3000; ++i) {
    ASSERT_NO_FATAL_FAILURE(led(1, JointVector::Zero(7)));
    EXPECT_LT(energy(), before * (1 + 1e-6) + 1e-9) << i;
    before = energy();
  }
  EXPECT_LT(plant.measured().velocity.cwiseAbs().maxCoeff(), 1e-3);
}

struct FloatingArmMeets : ::testing::Test {
  static constexpr std::uint16_t contact_event = 2113, retracted = 2112, motion_done = 2101, too_near_event = 2111;
  const std::string done = "1 3 7";
  robot_arm::testing::FlownFree flown;

  void begin() {
    flown.plant.place(ready_posture);
    flown.operate();
  }
  std::string react_by(std::uint8_t reaction, double limit = 0.3) {
    const auto request = flown.rig.call_with("SET_CONTACT", {Value{Number{reaction}}, Value{limit}});
    flown.cycle(5);
    return flown.rig.outcome(request);
  }
  hirosco::testing::Sent ask(const char* function, std::initializer_list<double> numbers = {}) {
    const auto request = flown.rig.call(function, numbers);
    flown.cycle(3);
    return request;
  }
  /// Along x, of which 32 N are 30 N m of 80 for the shoulder.
  void push(double force_n) { flown.plant.push_n = {force_n, 0, 0}; }
  hirosco::testing::Sent move_and_meet() {
    const auto motion = ask("MOVE_TOOL", {0.1, 0, 0, 8});
    flown.cycle(3500);
    EXPECT_EQ(flown.rig.outcome(motion), done.substr(0, 3));
    push(-32);
    for (int i = 0; i < 200 && flown.rig.events(contact_event) == 0; ++i) flown.cycle();
    flown.cycle(20);
    return motion;
  }
  [[nodiscard]] double speed() const { return flown.plant.measured().velocity.cwiseAbs().maxCoeff(); }
};

TEST_F(FloatingArmMeets, NobodyOnItsOwnWays) {
  begin();
  ASSERT_EQ(react_by(1, 0.1), done);
  const auto motion = ask("MOVE_TOOL", {0.1, 0.05, -0.05, 6});
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), done);
  EXPECT_EQ(flown.rig.events(contact_event), 0);
}

TEST_F(FloatingArmMeets, SomebodyAndStands) {
  begin();
  const auto motion = move_and_meet();
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 3 8:800c"));
  EXPECT_EQ(flown.rig.events(contact_event), 1) << "it is what is in force at first";
  push(0);
  flown.cycle(1000);
  const JointVector there = flown.plant.measured().position;
  flown.cycle(1000);
  EXPECT_LT(speed(), 1e-3);
  EXPECT_LT(flown.off(there), 2e-3);
  EXPECT_EQ(flown.rig.events(contact_event), 1);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  const auto away = ask("MOVE_TOOL", {-0.02, 0, 0, 3});
  flown.finish(away);
  EXPECT_EQ(flown.rig.outcome(away), done);
}

TEST_F(FloatingArmMeets, SomebodyAndTellsHowManyCyclesWereMissedBefore) {
  begin();
  const auto motion = ask("MOVE_TOOL", {0.1, 0, 0, 8});
  flown.cycle(3500);
  flown.rig.clock.advance(5ms);
  flown.cycle(100);
  ASSERT_EQ(flown.rig.events(contact_event), 0) << "nobody was there";
  push(-32);
  for (int i = 0; i < 200 && flown.rig.events(contact_event) == 0; ++i) flown.cycle();
  flown.cycle(20);
  const std::string words = robot_arm::cycles_missed_before;
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 3 8:800c"));
  EXPECT_THAT(flown.rig.outcome(motion),
              EndsWith("0000000000000005" + hirosco::testing::hex(std::as_bytes(std::span{words}))));
}

TEST_F(FloatingArmMeets, SomebodyAndGoesBackByTheWayItCame) {
  begin();
  ASSERT_EQ(react_by(3), done);
  const auto motion = move_and_meet();
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 3 8:800c"));
  push(0);
  flown.cycle(8000);
  EXPECT_EQ(flown.rig.events(retracted), 1);
  EXPECT_EQ(flown.rig.events(motion_done), 0) << "nobody had asked for that";
  EXPECT_LT(flown.off(ready_posture), 0.03);
  EXPECT_LT(speed(), 1e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmMeets, SomebodyWhileItStandsAndIsToldAlone) {
  begin();
  push(-32);
  flown.cycle(300);
  EXPECT_EQ(flown.rig.events(contact_event), 1);
  push(0);
  flown.cycle(1000);
  EXPECT_LT(flown.off(ready_posture), 5e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmMeets, NobodyWhereThatIsWhatWasSaid) {
  begin();
  ASSERT_EQ(react_by(0), done);
  push(-32);
  flown.cycle(300);
  EXPECT_EQ(flown.rig.events(contact_event), 0);
}

TEST_F(FloatingArmMeets, SomebodyAndGivesWayUntilHold) {
  begin();
  ASSERT_EQ(react_by(2), done);
  const auto motion = move_and_meet();
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 3 8:800c"));
  push(-5);
  const JointVector there = flown.plant.measured().position;
  flown.cycle(1000);
  EXPECT_GT(flown.off(there), 0.01);
  EXPECT_THAT(flown.rig.outcome(ask("MOVE_TOOL", {0.02, 0, 0, 3})), StartsWith("1 4:800d"));
  EXPECT_THAT(flown.rig.outcome(ask("SET_PAYLOAD", {1, 0, 0, 0})), StartsWith("1 4:800d"));
  EXPECT_EQ(flown.rig.events(contact_event), 1) << "who pushes leads";
  push(0);
  EXPECT_EQ(flown.rig.outcome(ask("HOLD")), done);
  flown.cycle(1000);
  EXPECT_LT(speed(), 1e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

struct FloatingArmFloats : FloatingArmMeets {
  /// A ball is where this push leads the tool in four seconds, most of it by the fore roll.
  void lead_before_a_volume() {
    const JointVector led = ready_posture + vector_of(std::array{0.025, 0.011, 0.018, 0.004, 0.5, -0.21, 0.063});
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = led, .qd = JointVector::Zero(7)});
    robot_arm::testing::keep_out_ball(flown, dynamics.frame_pose(flown.model.find_frame("tool").value()).position);
    EXPECT_EQ(flown.rig.outcome(ask("FLOAT")), done);
    flown.plant.push_n = {0, 1.5, 0};
    for (int i = 0; i < 12'000 && flown.rig.events(too_near_event) == 0; ++i) flown.cycle();
    ASSERT_EQ(flown.rig.events(too_near_event), 1);
  }
};

TEST_F(FloatingArmFloats, WhereverItIsLedAndStandsWhereItIsLeft) {
  begin();
  EXPECT_EQ(flown.rig.outcome(ask("FLOAT")), done);
  flown.cycle(1000);
  EXPECT_LT(flown.off(ready_posture), 1e-6) << "nothing moves it";
  flown.plant.push_n = {0, 2, 0};
  flown.cycle(1000);
  EXPECT_GT(flown.off(ready_posture), 0.03);
  EXPECT_LT(flown.fastest, 0.2);
  flown.plant.push_n.setZero();
  flown.cycle(2000);
  EXPECT_LT(speed(), 1e-3);
  EXPECT_EQ(flown.rig.outcome(ask("FLOAT")), done) << "it does";
  const JointVector there = flown.plant.measured().position;
  EXPECT_EQ(flown.rig.outcome(ask("HOLD")), done);
  flown.cycle(1000);
  EXPECT_LT(flown.off(there), 2e-3);
  const auto motion = ask("MOVE_TOOL", {0.02, 0, 0, 3});
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), done);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Of 9 N m that hold it against a push; what comes behind that the push itself makes, and dampers.
TEST_F(FloatingArmFloats, FromThenOnAndNoMoreWithoutAStepInTorqueWhoeverPushes) {
  begin();
  push(-10);
  flown.cycle(1000);
  for (const char* function : {"FLOAT", "HOLD"}) {
    JointVector last = flown.plant.measured().torque;
    if (function == std::string_view{"FLOAT"}) {
      EXPECT_GT(last.cwiseAbs().maxCoeff(), 8) << "it holds it";
    }
    const auto request = flown.rig.call(function);
    double steepest = 0;
    for (int i = 0; i < 100; ++i) {
      flown.cycle();
      const JointVector& now = flown.plant.measured().torque;
      steepest = std::max(steepest, (now - last).cwiseAbs().maxCoeff());
      last = now;
    }
    EXPECT_EQ(flown.rig.outcome(request), done) << function;
    EXPECT_LT(steepest, 1) << function;
  }
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmFloats, FromAStandAlone) {
  begin();
  const auto motion = ask("MOVE_TOOL", {0.05, 0, 0, 4});
  flown.cycle(1500);
  EXPECT_THAT(flown.rig.outcome(ask("FLOAT")), StartsWith("1 4:0108"));
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), done);
}

TEST_F(FloatingArmFloats, AndStandsBeforeAVolumeWhoeverLeadsItThere) {
  begin();
  ASSERT_NO_FATAL_FAILURE(lead_before_a_volume());
  flown.cycle(3000);
  EXPECT_LT(speed(), 1e-2);
  EXPECT_GT(flown.told_number("CLEARANCE"), 0.01);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmFloats, NoMoreWhereItStandsBeforeAVolumeThoughWhoMeetsItHasItFloat) {
  begin();
  ASSERT_EQ(react_by(2, 0.05), done);
  ASSERT_NO_FATAL_FAILURE(lead_before_a_volume());
  push(0);
  flown.cycle(1000);
  ASSERT_EQ(flown.rig.events(contact_event), 0);
  push(-12);
  for (int i = 0; i < 100 && flown.rig.events(contact_event) == 0; ++i) flown.cycle();
  EXPECT_EQ(flown.rig.events(contact_event), 1);
  EXPECT_THAT(flown.rig.outcome(ask("MOVE_TOOL", {0, -0.02, 0, 3})), Not(StartsWith("1 4:800d"))) << "it is not led";
}

TEST_F(FloatingArmFloats, AndTellsAnewOfWhoPushesOnWhenItIsToHold) {
  begin();
  ASSERT_EQ(react_by(2, 0.05), done);
  push(-6);
  for (int i = 0; i < 200 && flown.rig.events(contact_event) == 0; ++i) flown.cycle();
  flown.cycle(100);
  ASSERT_EQ(flown.rig.events(contact_event), 1);
  EXPECT_EQ(flown.rig.outcome(ask("HOLD")), done);
  flown.cycle(200);
  EXPECT_EQ(flown.rig.events(contact_event), 2);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmFloats, AndIsStoppedWherePushedFasterThanAJointMayBe) {
  begin();
  EXPECT_EQ(flown.rig.outcome(ask("FLOAT")), done);
  flown.plant.push_n = {0, 60, 0};
  flown.cycle(1000);
  EXPECT_NE(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmFloats, AndNeitherItNorContactsAreInADescriptorThatLeavesThemOut) {
  std::string text = robot_arm::testing::floating_descriptor();
  const auto cut = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.erase(at, text.find(to, at) + to.size() - at);
  };
  cut("<StructRef name=\"CONTACT_WATCH\"", "</StructRef>");
  for (const char* name : {"EXTERNAL_TORQUE", "RETRACT_DISTANCE", "FLOAT_DAMPING"})
    cut(std::string{"<ParamRef name=\""} + name, "/>");
  for (const char* function : {"FLOAT", "SET_CONTACT"}) cut(std::string{"<Function name=\""} + function, "</Function>");
  cut("<Event name=\"CONTACT\"", "</Event>");
  cut("<Enumeration name=\"REACTIONS\"", "</Enumeration>");
  robot_arm::testing::FlownFloating other{text};
  other.plant.place(ready_posture);
  other.operate();
  const auto motion = other.rig.call("MOVE_TOOL", {0.02, 0, 0, 2});
  other.finish(motion);
  EXPECT_EQ(other.rig.outcome(motion), done);
}

}  // namespace
}  // namespace hirosco
