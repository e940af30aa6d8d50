// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "hirosco/pus/st17_test/test_service.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "subsystems/joystick/joystick.hpp"
#include "subsystems/manipulator/manipulator.hpp"
#include "tests/integration/flight.hpp"

/// A whole craft whose manipulator has to pass its self test before it may act (adr 0073).
namespace hirosco::testing {
namespace {

using pus::TestService;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Each configuration of these requires its self test, as a mission's own descriptors would say.
std::function<void(descriptor::Mission&)> requires_of(std::vector<std::string> names) {
  return [names](descriptor::Mission& mission) {
    hand_rests(mission);
    for (auto& member : mission.subsystems)
      if (std::ranges::find(names, member.subsystem.name) != names.end())
        for (auto& configuration : member.subsystem.configurations)
          configuration.self_test = descriptor::SelfTest::Required;
  };
}
void wary(descriptor::Mission& mission) { requires_of({"MANIPULATOR"})(mission); }

/// A sign, lost between the law and what is put out.
manipulator::Joints reversed(manipulator::JointController& law, const manipulator::Joints& desired_rad,
                             const manipulator::Measured& measured, const manipulator::Gains& gains) noexcept {
  manipulator::Joints torque = law.motor_torque(desired_rad, measured, gains);
  torque[1] = -torque[1];
  return torque;
}

Plan with_wrong_sign() {
  Plan plan{.edit = wary};
  plan.subsystems["hirosco-manipulator"] = [] { return make_manipulator_with(reversed); };
  return plan;
}

/// Outcomes that TM[17,129] told.
std::vector<int> outcomes(Flight& flight) {
  std::vector<int> found;
  for (const auto& record : flight.records()) {
    const auto report = pus::TelemetryView::parse(record.packet);
    if (report && report->service() == TestService::service_type && report->subtype() == TestService::self_test_report)
      found.push_back(std::to_integer<int>(report->source_data()[0]));
  }
  return found;
}
constexpr int passed = 1, failed = 2;

TEST(SelfTestInFlight, IsAStepOfTheWayUpThatCostsFewMilliseconds) {
  Flight plain{{.edit = hand_rests}}, flight{{.edit = wary}};
  ASSERT_TRUE(plain.commission());
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Operational);
  EXPECT_THAT(outcomes(plain), IsEmpty());
  EXPECT_THAT(outcomes(flight), ElementsAre(passed));
  EXPECT_LT(flight.craft().now() - plain.craft().now(), 50ms);
  // Its telecommand is the supervisor's, logged and verified as all are.
  std::vector<int> stages;
  std::uint32_t id = 0;
  for (const auto& record : flight.records()) {
    if (const auto asked = pus::TelecommandView::parse(record.packet);
        asked && asked->service() == TestService::service_type && asked->subtype() == TestService::run_self_test) {
      EXPECT_EQ(asked->apid(), 10);
      id = asked->request_id();
    }
    const auto report = pus::TelemetryView::parse(record.packet);
    if (id == 0 || !report || report->service() != 1) continue;
    if (OctetReader{report->source_data()}.get<std::uint32_t>() == id) stages.push_back(report->subtype());
  }
  EXPECT_THAT(stages, ElementsAre(1, 3, 7)) << "as it asks for: a self test may take longer than a start";
}

TEST(SelfTestInFlight, OfArmAndStickIsPassedByBothOnTheWayUpAndWhenTheModeChanges) {
  Flight flight{{.edit = requires_of({"MANIPULATOR", "JOYSTICK"})}};
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  EXPECT_THAT(outcomes(flight), ElementsAre(passed, passed));
  EXPECT_EQ(flight.state("JOYSTICK"), State::Operational);
  EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SET_MODE", {2}, 20s).completed) << flight.story().text();
  EXPECT_THAT(outcomes(flight), ElementsAre(passed, passed, passed, passed));
  EXPECT_EQ(flight.state("JOYSTICK"), State::Operational);
}

TEST(SelfTestInFlight, KeepsAHandFromAForceThatWouldDrawItIn) {
  Plan plan{.edit = requires_of({"JOYSTICK"})};
  plan.subsystems["hirosco-joystick"] = [] {
    return make_joystick_with(
        [](joystick::DisplayLaw& law, const joystick::DisplayLaw::Input& input, double scale) noexcept {
          joystick::Axes torque = law.torque(input, scale);
          for (double& each : torque) each = -each;
          return torque;
        });
  };
  Flight flight{plan};
  EXPECT_FALSE(flight.commission());
  EXPECT_TRUE(
      flight.story().has("commissioning stopped: JOYSTICK self test: execution error: "
                         "it would not push against what the robot presses on, axis 1"))
      << flight.story().text();
  EXPECT_EQ(flight.state("JOYSTICK"), State::SafeOperational);
}

TEST(SelfTestInFlight, ThatFailsEndsTheCommissioningWithItsReasonAndNothingMoves) {
  Flight flight{with_wrong_sign()};
  EXPECT_FALSE(flight.commission());
  EXPECT_EQ(
      flight.story().missing_in_order(
          {"MANIPULATOR TC[17,128] failed: execution error: driven away from its setpoint, joint 2",
           "commissioning stopped: MANIPULATOR self test: execution error: driven away from its setpoint, joint 2"}),
      "")
      << flight.story().text();
  EXPECT_EQ(flight.state("MANIPULATOR"), State::SafeOperational);
  EXPECT_EQ(flight.state("JOYSTICK"), State::SafeOperational) << "nobody has gone ahead";
  EXPECT_THAT(outcomes(flight), ElementsAre(failed));
  const auto before = flight.device<simulation::RobotDevice>("robot").arm().joint_torque_n_m();
  // What an operator tries then: by hand, past the commissioning.
  const auto refused = flight.set_state("MANIPULATOR", State::Operational);
  ASSERT_TRUE(refused.failure);
  EXPECT_EQ(*refused.failure, pus::FailureCode::SelfTestNotPassed);
  EXPECT_EQ(refused.failure_subtype, 4);
  const auto again = flight.craft().command("MANIPULATOR", "SELF_TEST", {});
  ASSERT_TRUE(again.failure);
  EXPECT_EQ(*again.failure, pus::FailureCode::ExecutionError);
  EXPECT_EQ(again.failure_subtype, 8);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::SafeOperational);
  EXPECT_EQ(flight.device<simulation::RobotDevice>("robot").arm().joint_torque_n_m(), before);
  EXPECT_THAT(outcomes(flight), ElementsAre(failed, failed));
}

TEST(SelfTestInFlight, IsRefusedByTheSupervisorInOtherStates) {
  Flight flight{{.edit = wary}};
  ASSERT_TRUE(flight.commission());
  const auto refused = flight.craft().command("MANIPULATOR", "SELF_TEST", {});
  ASSERT_TRUE(refused.failure);
  EXPECT_EQ(*refused.failure, pus::FailureCode::WrongState);
  EXPECT_EQ(refused.failure_subtype, 2);
  EXPECT_TRUE(flight.craft().command("MANIPULATOR", "REPORT_SELF_TEST", {}).completed);
  EXPECT_THAT(outcomes(flight), ElementsAre(passed, passed));
}

TEST(SelfTestInFlight, ThatNobodyWroteSaysSo) {
  Flight flight{{.edit = requires_of({"COMMUNICATION"})}};
  EXPECT_FALSE(flight.commission());
  EXPECT_TRUE(
      flight.story().has("commissioning stopped: COMMUNICATION self test: execution error: it has no self test"))
      << flight.story().text();
}

}  // namespace
}  // namespace hirosco::testing
