// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/driven.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// The floating arm as its subsystem, in JOINTS, where it takes its base as standing: here it does, and the test is its device. On a base that gives way
/// it is flown in missions/servicer/tests.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string floating_folder = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/";

[[nodiscard]] std::string floating_descriptor() {
  std::string text = descriptor::file_system()(floating_folder + "floating_arm.xml").value();
  constexpr std::string_view file = "value=\"floating_arm.urdf\"";
  for (auto at = text.find(file); at != std::string::npos; at = text.find(file, at + 1))
    text.insert(at + std::string_view{"value=\""}.size(), floating_folder);
  return text;
}

struct FlownFloating : hirosco::testing::Driven {
  robotics::Model model = robot_arm::testing::model_of(floating_folder + "floating_arm.urdf");
  robot_arm::testing::Plant plant{model};
  double fastest{0};

  FlownFloating() : Driven{make_floating_arm(), floating_descriptor(), "mcs-arm"} {
    plant.set_gravity(robotics::Vector3::Zero());
    plant.step_s = 250e-6;
  }
  std::vector<double> play(std::span<const double> torques) override {
    if (mode == DeviceMode::Active) plant.step(vector_of(torques), 0.001);
    else plant.place(plant.measured().position);
    const robot_arm::Measured& measured = plant.measured();
    fastest = std::max(fastest, measured.velocity.cwiseAbs().maxCoeff());
    std::vector<double> numbers;
    for (const auto* each : {&measured.position, &measured.velocity, &measured.torque})
      numbers.insert(numbers.end(), each->begin(), each->end());
    return numbers;
  }
};

struct FloatingArmWay : ::testing::Test {
  static constexpr std::uint16_t too_near_event = 2111;
  FlownFloating flown;
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  JointVector folded = vector_of(std::array{0.107, 0.76, -0.327, -1.758, -0.059, 2.35, -0.005});

  void begin(const JointVector& at) {
    flown.plant.place(at);
    flown.operate();
  }
  [[nodiscard]] robotics::Vector3 tool() const {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = flown.plant.measured().position, .qd = JointVector::Zero(7)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value()).position;
  }
  hirosco::testing::Sent move_tool(double x, double y, double z, double duration_s) {
    const auto request = flown.rig.call("MOVE_TOOL", {x, y, z, duration_s});
    flown.cycle(3);
    return request;
  }
  /// A ball of 5 cm there, that no link comes near.
  void keep_out(const robotics::Vector3& there) {
    std::vector<std::optional<Value>> numbers;
    for (const double number : {there.x(), there.y(), there.z(), there.x(), there.y(), there.z(), 0.05})
      numbers.emplace_back(number);
    numbers.resize(28, Value{0.0});
    const auto set = flown.rig.call_with("KEEP_OUT", numbers);
    flown.cycle(3);
    ASSERT_EQ(flown.rig.outcome(set), "1 3 7");
  }
  [[nodiscard]] static std::string hex_of(const std::string& words) {
    return testing::hex(std::as_bytes(std::span{words}));
  }
  void expect_refused(hirosco::testing::Sent request, const char* pair) {
    flown.cycle(70);
    EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:8009")) << pair;
    EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of(pair)));
    flown.cycle(500);
    EXPECT_LT(flown.fastest, 1e-6) << "nothing has moved";
    EXPECT_EQ(flown.rig.events(too_near_event), 0);
    EXPECT_EQ(flown.rig.inhibited(), 0u);
  }
};

TEST_F(FloatingArmWay, ThatWouldFoldItOntoItselfIsToldWithThePairWithin64CyclesAndNothingMoves) {
  begin(folded);
  expect_refused(move_tool(-0.35, 0, -0.35, 25), "link5 and link7");
  const auto away = move_tool(0.02, 0, 0.02, 2);
  flown.finish(away);
  EXPECT_EQ(flown.rig.outcome(away), "1 3 7");
}

/// In the middle of it: beside the last tube, which is clear of it before and would be behind.
TEST_F(FloatingArmWay, ThroughAVolumeIsToldWithThePairAndNothingMoves) {
  begin(ready);
  keep_out(tool() + robotics::Vector3{-0.05, 0.2, 0});
  expect_refused(move_tool(0, 0.4, 0, 25), "and a volume to keep out of");
}

/// What was judged meanwhile costs no time: 64 cycles later it would be 3 mm behind.
TEST_F(FloatingArmWay, ThatIsFreeIsGoneToItsEndInItsTime) {
  begin(ready);
  const robotics::Vector3 from = tool(), offset{0, 0.1, 0};
  const auto request = move_tool(0, 0.1, 0, 4);
  flown.cycle(1997);
  EXPECT_LT((tool() - from - offset / 2).norm(), 2.5e-3);
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
  EXPECT_LT((tool() - from - offset).norm(), 1.5e-3);
}

/// Nobody knew of the volume when it began: what stops it before is there still.
TEST_F(FloatingArmWay, OnWhichAVolumeIsDeclaredMeanwhileIsStoppedBeforeIt) {
  begin(ready);
  const robotics::Vector3 from = tool();
  const auto request = move_tool(0, 0.4, 0, 25);
  flown.cycle(2000);
  keep_out(from + robotics::Vector3{-0.05, 0.3, 0});
  flown.finish(request);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:8009"));
  EXPECT_EQ(flown.rig.events(too_near_event), 1);
  flown.cycle(1000);
  EXPECT_LT(flown.plant.measured().velocity.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmWay, IsGoneByNobodyWhoIsToldToHoldWhileItIsJudged) {
  begin(ready);
  const auto request = move_tool(0.02, 0, 0, 2);
  const auto hold = flown.rig.call("HOLD");
  flown.cycle(200);
  EXPECT_EQ(flown.rig.outcome(hold), "1 3 7");
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8"));
  flown.cycle(2000);
  EXPECT_LT(flown.fastest, 1e-6);
}

TEST(FloatingArmThatIsSlow, IsNotConfiguredWithACycleThatLeavesNoLaw) {
  std::string text = floating_descriptor();
  constexpr std::string_view cycle = "sampling_us=\"1000\"";
  text.replace(text.find(cycle), cycle.size(), "sampling_us=\"5000\"");
  const auto author = make_floating_arm();
  hirosco::testing::Rig rig{*author, text};
  ASSERT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_THAT(rig.configure_now(1), StartsWith("1 3 8:"));
  EXPECT_THAT(rig.explanations, ::testing::Contains(HasSubstr("sampling_us is too long")));
}

}  // namespace
}  // namespace hirosco
