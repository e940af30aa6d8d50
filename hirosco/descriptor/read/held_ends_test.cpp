// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "hirosco/descriptor/model/in_flight.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/testing.hpp"

/// Ways to second inhibits and power switches, and how old their answers may be (docs/adr/0237).
namespace hirosco::descriptor {
namespace {

using namespace std::chrono_literals;
using testing::changed;
using testing::data;
using testing::read_text;
using testing::rendered;

TEST(HeldEnds, HaveFallBacksAndAnAgeLimit) {
  const auto reading = read_text(R"(<Subsystem name="S" id="10">
    <Device name="DRIVE" actuator="yes"><Output><Field name="ANGLE" type="DOUBLE" safe="0"/></Output>
      <Enable transfer="shared_memory" address="a" silence_ms="30" goes_on="yes">
        <FallBack transfer="shared_memory" address="b"/><FallBack transfer="unix" address="c"/></Enable>
      <Power transfer="unix" address="power" silence_ms="200" silence_reduced_ms="100"><FallBack transfer="unix" address="power2"/></Power>
    </Device>
    <Device name="PLAIN" actuator="yes"><Output><Field name="ANGLE" type="DOUBLE" safe="0"/></Output>
      <Enable transfer="unix" address="plain"/></Device>
    <Device name="SLOW" actuator="yes"><Output><Field name="ANGLE" type="DOUBLE" safe="0"/></Output>
      <Enable transfer="unix" address="slow" silence_ms="300"/></Device>
  </Subsystem>)");
  ASSERT_TRUE(reading.value);
  const HeldTerms& drive = reading.value->devices.at(0).enable_terms;
  ASSERT_EQ(drive.fall_backs.size(), 2U);
  EXPECT_EQ(drive.fall_backs[0].address, "b");
  EXPECT_EQ(drive.fall_backs[1].transfer, Transfer::Unix);
  EXPECT_EQ(drive.silence, 30ms);
  EXPECT_EQ(drive.silence_reduced, 80ms) << "left out";
  EXPECT_TRUE(drive.goes_on);
  const HeldTerms& power = reading.value->power_switches.at(0).terms;
  EXPECT_EQ(power.fall_backs.at(0).address, "power2");
  EXPECT_EQ(power.silence, 200ms);
  EXPECT_EQ(power.silence_reduced, 100ms);
  const HeldTerms& plain = reading.value->devices.at(1).enable_terms;
  EXPECT_TRUE(plain.fall_backs.empty());
  EXPECT_EQ(plain.silence, Duration{}) << "no limit, as ever";
  EXPECT_EQ(plain.silence_reduced, Duration{});
  EXPECT_FALSE(plain.goes_on);
  EXPECT_EQ(reading.value->devices.at(2).enable_terms.silence_reduced, 300ms) << "no less than the other";
}

TEST(HeldEnds, HaveFallBacksAtOtherAddressesInAnotherInstance) {
  const auto reading = read_subsystem(data / "coronagraph.xml", [](const auto& file) -> Result<std::string> {
    return changed(R"(transfer="shared_memory" address="orbiter-robot-enable"/>)",
                   R"(transfer="shared_memory" address="orbiter-robot-enable" silence_ms="30">
                      <FallBack transfer="shared_memory" address="enable-b"/></Enable>
                      <Power transfer="shared_memory" address="power" silence_ms="30">
                      <FallBack transfer="shared_memory" address="power-b"/></Power>)",
                   file_system()(file).value());
  });
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  SubsystemDescriptor robot = *reading.value;
  ASSERT_TRUE(apply_change(robot, "--fall-back", "PLATE=enable-b=left-enable-b"));
  ASSERT_TRUE(apply_change(robot, "--fall-back", "PLATE=power-b=left-power-b"));
  EXPECT_EQ(robot.devices[0].enable_terms.fall_backs[0].address, "left-enable-b");
  EXPECT_EQ(robot.power_switches[0].terms.fall_backs[0].address, "left-power-b");
  EXPECT_EQ(apply_change(robot, "--fall-back", "PLATE=left-enable-b=orbiter-robot-enable").error().code,
            ErrorCode::Mismatch);
  EXPECT_EQ(apply_change(robot, "--fall-back", "PLATES=power-b=x").error().code, ErrorCode::NotFound);
}

TEST(HeldEnds, StayAsTheyAreInFlight) {
  const auto with = [](const std::string& enable, const std::string& power) {
    const auto reading = read_text(R"(<Subsystem name="S" id="10">
      <Device name="DRIVE" actuator="yes"><Output><Field name="ANGLE" type="DOUBLE" safe="0"/></Output>
        <Enable transfer="unix" address="a" )" +
                                   enable + R"(</Enable>
        <Power transfer="unix" address="p" )" +
                                   power + R"(</Power>
      </Device></Subsystem>)");
    EXPECT_TRUE(reading.value) << enable << power;
    return *reading.value;
  };
  const std::string other = R"(<FallBack transfer="unix" address=")";
  const std::string enable = R"(silence_ms="30" goes_on="yes">)" + other + R"(b"/>)";
  const std::string power = R"(silence_ms="30">)" + other + R"(q"/>)";
  const SubsystemDescriptor flown = with(enable, power);
  EXPECT_TRUE(obstacles(flown, with(enable, power)).empty());
  for (const std::string& changes :
       {R"(silence_ms="31" goes_on="yes">)" + other + R"(b"/>)", R"(silence_ms="30">)" + other + R"(b"/>)",
        R"(silence_ms="30" silence_reduced_ms="79" goes_on="yes">)" + other + R"(b"/>)",
        R"(silence_ms="30" goes_on="yes">)" + other + R"(c"/>)", std::string{R"(silence_ms="30">)"}}) {
    const auto found = obstacles(flown, with(changes, power));
    ASSERT_EQ(found.size(), 1U) << changes;
    EXPECT_EQ(found[0].what.substr(0, 32), "device DRIVE: its second inhibit") << found[0].what;
  }
  EXPECT_EQ(obstacles(flown, with(enable, R"(silence_ms="30">)")).size(), 1U);
}

}  // namespace
}  // namespace hirosco::descriptor
