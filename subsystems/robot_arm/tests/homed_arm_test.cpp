// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hirosco/descriptor/read/read.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "subsystems/robot_arm/testing/homing.hpp"

/// An arm in orbit whose encoders count from where they were switched on: it finds its zeros in one mode and works in the next (docs/adr/0208), on virtual time,
/// judged by what its world tells.
namespace hirosco {
namespace {

using Joints = std::array<double, 6>;

constexpr Joints goal{-0.3, 0.2, 0.6, 0.5, -0.5, 1.0};

/// Its joints begin at 0.2, 0.5, 1.2, -0.6, 0.7, 0.1, and each mark is 0.1 from there.
constexpr const char* mission_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Mission name="HOMED">
  <Supervisor descriptor="../../../supervisor/supervisor.xml">
    <Database strategy="ascii" path="log/homed.log"/>
    <Ground subsystem="COMMUNICATION" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="hirosco-communication" descriptor="../../communication/communication.xml"/>
  <Subsystem executable="hirosco-robot-arm" descriptor="../robot_arm.xml"/>
  <SimulatedDevice name="arm" executable="hirosco-sim-mujoco" subsystem="ARM" device="ARM" seed="5">
    <Setting name="gravity" value="0 0 0"/>
    <Setting name="rotors" value="0.5,0.5,0.4,0.1,0.1,0.1"/>
    <Setting name="posture" value="0.2,0.5,1.2,-0.6,0.7,0.1"/>
    <Setting name="mass" value="1.1"/>
    <Setting name="encoders" value="0.3,0.6,1.1,-0.5,0.8,0.0"/>
  </SimulatedDevice>
  <Modes initial="commissioning" start="homing">
    <Mode name="commissioning">
      <Permit subsystem="*" functions="SET_STATE CONFIGURE SET_MODE SHUTDOWN"/>
    </Mode>
    <Mode name="homing">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="ARM" configuration="HOMING" state="Operational"/>
      <Permit subsystem="ARM" functions="HOME HOLD STOP"/>
      <Permit subsystem="SUPERVISOR" functions="SET_MODE SHUTDOWN"/>
      <Permit subsystem="*" services="3 5 17 20"/>
    </Mode>
    <Mode name="operation">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="ARM" configuration="POSITION" state="Operational"/>
      <Permit subsystem="ARM" functions="MOVE_J HOLD STOP"/>
      <Permit subsystem="SUPERVISOR" functions="SET_MODE SHUTDOWN"/>
      <Permit subsystem="*" services="3 5 17 20"/>
    </Mode>
  </Modes>
  <Recovery>
    <Plan name="died"><When event="PROCESS_DIED"/><Do action="shut_down_network"/></Plan>
    <Plan name="network-down"><When severity="high"/><Do action="shut_down_network"/></Plan>
    <Plan name="to-safe"><When severity="medium"/><Do action="set_state" state="SafeOperational"/></Plan>
    <Plan name="ground-lost"><When event="GROUND_LINK_LOST"/><Do action="log"/></Plan>
  </Recovery>
</Mission>
)";

struct HomedArm : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void SetUp() override {
    const std::filesystem::path arm = std::filesystem::path{HIROSCO_SOURCE_DIR} / "subsystems/robot_arm";
    const auto descriptor = descriptor::file_system()(arm / "robot_arm.xml");
    ASSERT_TRUE(descriptor);
    flown.emplace(simulation::Plan{
        .mission = arm / "tests" / "homed.xml",
        .files = {
            {"homed.xml", mission_text},
            {"robot_arm.xml", robot_arm::testing::with_homing(*descriptor, robot_arm::testing::homing_numbers())}}});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  simulation::SimulatedDevice& arm() { return *flown->craft().device("arm"); }
  /// Of each joint: q, qd or referenced_ and its number.
  Joints told(const char* what) {
    const std::string words = " " + arm().truth();
    Joints found{};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::string name = fmt::format(" {}{}=", what, i + 1);
      const auto at = words.find(name);
      found.at(i) = at == words.npos ? NAN : std::atof(words.c_str() + at + name.size());
    }
    return found;
  }
  [[nodiscard]] static double apart(const Joints& one, const Joints& other) {
    double most = 0;
    for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, std::abs(one.at(i) - other.at(i)));
    return most;
  }
  simulation::CommandOutcome home() { return flown->craft().command("ARM", "HOME", {}, 120s); }
  simulation::CommandOutcome move_j() {
    std::vector<Value> numbers(goal.begin(), goal.end());
    numbers.emplace_back(0.5);
    return flown->craft().command("ARM", "MOVE_J", numbers, 70s);
  }
};

TEST_F(HomedArm, FindsItsZerosAndWorksInTheNextMode) {
  EXPECT_EQ(told("referenced_"), Joints{});
  double fastest = 0;
  flown->craft().on_cycle([&](std::string_view subsystem, TimePoint) {
    if (subsystem == "ARM") fastest = std::max(fastest, apart(told("qd"), {}));
  });
  ASSERT_TRUE(home().completed) << flown->story().text();
  EXPECT_EQ(told("referenced_"), (Joints{1, 1, 1, 1, 1, 1}));
  EXPECT_LT(fastest, 0.25);
  flown->craft().on_cycle([](std::string_view, TimePoint) {});
  ASSERT_TRUE(flown->set_mode("operation").completed) << flown->story().text();
  ASSERT_TRUE(move_j().completed) << flown->story().text();
  EXPECT_LT(apart(told("q"), goal), 2e-3) << "where it says that it is it is";
  EXPECT_EQ(flown->inhibited("ARM"), 0U);
}

TEST_F(HomedArm, IsNotBroughtIntoAnotherModeBeforeItKnowsItsZeros) {
  EXPECT_FALSE(flown->set_mode("operation").completed);
  EXPECT_NE(flown->state("ARM"), State::Operational) << flown->story().text();
  EXPECT_TRUE(flown->story().has("does not know its zero")) << flown->story().text();
}

TEST_F(HomedArm, ThatForgetsItsZerosStandsAndSaysWhich) {
  ASSERT_TRUE(home().completed) << flown->story().text();
  ASSERT_TRUE(flown->set_mode("operation").completed) << flown->story().text();
  ASSERT_TRUE(arm().fault("encoders forget"));
  flown->craft().run(2s);
  EXPECT_TRUE(flown->story().has("ARM medium NOT_REFERENCED JOINT=turn")) << flown->story().text();
  EXPECT_NE(flown->state("ARM"), State::Operational) << flown->story().text();
  EXPECT_LT(apart(told("qd"), {}), 1e-3);
}

}  // namespace
}  // namespace hirosco
