// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "subsystems/manipulator/manipulator.hpp"

/// What the arm's self test finds before anything moves: planted errors of its law and of its sensors.
namespace hirosco {
namespace {

using manipulator::Gains;
using manipulator::JointController;
using manipulator::Joints;
using manipulator::Law;
using manipulator::Measured;

/// manipulator.xml, whose configuration STANDALONE requires the self test.
std::string wary() {
  std::string text = descriptor::file_system()(HIROSCO_SOURCE_DIR "/subsystems/manipulator/manipulator.xml").value();
  const std::string before = R"(<Configuration name="STANDALONE" id="1")";
  return text.replace(text.find(before), before.size(), before + R"( self_test="required")");
}

/// The test plays a robot that rests at home.
struct Tested {
  explicit Tested(Law law = manipulator::joint_law) : manipulator{make_manipulator_with(law)} {}
  std::unique_ptr<Subsystem> manipulator;
  testing::Rig rig{*manipulator, wary()};
  std::unique_ptr<DataFlow> robot =
      std::move(rig.flows.open({Transfer::SharedMemory, "manipulator-robot"}, FlowSide::Device)).value();
  std::array<double, 2> motor_rad{-0.8, 1.6}, joint_rad{-0.8, 1.6}, motor_rad_s{}, joint_rad_s{}, load_n_m{};
  float temperature_deg_c{20.0F};
  std::vector<DeviceMode> modes;
  std::vector<std::array<double, 2>> put_out;

  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange();
    }
    rig.service();
  }
  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = robot->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    modes.push_back(command.mode);
    OctetReader reader{command.payload, std::endian::little};
    const double first = reader.get<double>();
    put_out.push_back({first, reader.get<double>()});
    std::array<std::byte, 89> payload{};
    OctetWriter writer{payload, std::endian::little};
    for (const auto& pair : {motor_rad, motor_rad_s, joint_rad, joint_rad_s, load_n_m})
      writer.put(pair[0]).put(pair[1]);
    writer.put(temperature_deg_c).put(temperature_deg_c).put(std::uint8_t{0});
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload});
    static_cast<void>(robot->send(status.value()));
  }
  std::string after(testing::Sent request, int cycles) {
    cycle(cycles);
    return rig.outcome(request);
  }
  void up() {
    rig.bring_to(State::PreOperational, 1);
    cycle(5);
    ASSERT_EQ(after(rig.set_state(State::SafeOperational), 5), "1 3 7");
  }
  std::string self_test() { return after(rig.send(17, 128, {}), 8); }
  std::string operational() { return after(rig.set_state(State::Operational), 4); }
  /// The words of a failure and its number, as ground hears them.
  static std::string said(const std::string& outcome) {
    const auto at = outcome.find(":0202ff");
    if (at == std::string::npos) return outcome;
    const std::string data = outcome.substr(at + 9);
    std::string words;
    for (std::size_t i = 16; i + 1 < data.size(); i += 2)
      words += static_cast<char>(std::stoi(data.substr(i, 2), nullptr, 16));
    return words + " " + std::to_string(std::stoll(data.substr(0, 16), nullptr, 16));
  }
};

TEST(ManipulatorSelfTest, PassesInAFewCyclesAndLeavesTheArmAlone) {
  Tested tested;
  tested.up();
  const auto request = tested.rig.send(17, 128, {});
  EXPECT_EQ(tested.after(request, 5), "1 3 7") << "each joint to each side: 4 cycles";
  EXPECT_THAT(tested.modes, ::testing::Each(DeviceMode::Off));
  EXPECT_THAT(tested.put_out, ::testing::Each(std::array{0.0, 0.0}));
  tested.cycle();
  EXPECT_EQ(tested.operational(), "1 3 7");
  EXPECT_EQ(tested.modes.back(), DeviceMode::Active);
  EXPECT_THAT(tested.put_out.back(), ::testing::Each(::testing::DoubleNear(0, 1e-9))) << "and it holds where it is";
}

TEST(ManipulatorSelfTest, PassesAtItsStopsAndUnderLoad) {
  Tested tested;
  tested.motor_rad = tested.joint_rad = {-2.0, 2.6};
  tested.load_n_m = {2.5, -2.5};
  tested.up();
  EXPECT_EQ(tested.self_test(), "1 3 7");
}

/// What a slip of the pen makes of the law.
struct PlantedDefect {
  const char* what;
  Law law;
  const char* found;
};
constexpr PlantedDefect defects[]{
    {"all torques reversed",
     [](JointController& law, const Joints& desired, const Measured& measured, const Gains& gains) noexcept {
       Joints torque = law.motor_torque(desired, measured, gains);
       for (std::size_t i = 0; i < torque.size(); ++i) torque[i] = -torque[i];
       return torque;
     },
     "driven away from its setpoint, joint 1"},
    {"the second joint reversed",
     [](JointController& law, const Joints& desired, const Measured& measured, const Gains& gains) noexcept {
       Joints torque = law.motor_torque(desired, measured, gains);
       torque[1] = -torque[1];
       return torque;
     },
     "driven away from its setpoint, joint 2"},
    {"damping that drives",
     [](JointController& law, const Joints& desired, const Measured& measured, const Gains& gains) noexcept {
       Measured wrong = measured;
       wrong.motor_velocity_rad_s[0] = -wrong.motor_velocity_rad_s[0];
       return law.motor_torque(desired, wrong, gains);
     },
     "driven on in its motion, joint 1"},
    {"torque feedback that drives",
     [](JointController& law, const Joints& desired, const Measured& measured, const Gains& gains) noexcept {
       Measured wrong = measured;
       wrong.torque_n_m[1] = -wrong.torque_n_m[1];
       return law.motor_torque(desired, wrong, gains);
     },
     "driven with its load, joint 2"},
    {"joints exchanged",
     [](JointController& law, const Joints& desired, const Measured& measured, const Gains& gains) noexcept {
       Joints torque = law.motor_torque(desired, measured, gains);
       std::swap(torque[0], torque[1]);
       return torque;
     },
     "driven away from its setpoint, joint 1"},
    {"a joint that leaks into the other",
     [](JointController& law, const Joints& desired, const Measured& measured, const Gains& gains) noexcept {
       Joints torque = law.motor_torque(desired, measured, gains);
       torque[1] += 0.1 * torque[0];
       return torque;
     },
     "driven by another joint, joint 2"},
    {"a law that says nothing",
     [](JointController&, const Joints& desired, const Measured&, const Gains&) noexcept {
       return Joints::zeros(desired.size());
     },
     "driven away from its setpoint, joint 1"},
    {"a law that is no number",
     [](JointController& law, const Joints& desired, const Measured& measured, const Gains& gains) noexcept {
       Joints torque = law.motor_torque(desired, measured, gains);
       torque[0] = std::numeric_limits<double>::quiet_NaN();
       return torque;
     },
     "driven away from its setpoint, joint 1"},
};

TEST(ManipulatorSelfTest, FindsAWrongSignInTheLawAndKeepsTheArmFromOperational) {
  for (const PlantedDefect& defect : defects) {
    SCOPED_TRACE(defect.what);
    Tested tested{defect.law};
    tested.up();
    EXPECT_EQ(Tested::said(tested.self_test()), defect.found);
    const std::string refused = tested.operational();
    EXPECT_EQ(refused.substr(0, 8), "1 4:010a");
    const std::string words = std::string{defect.found}.substr(0, std::string{defect.found}.rfind(' '));
    EXPECT_NE(refused.find(testing::hex(std::as_bytes(std::span{words}))), std::string::npos) << "with the reason";
    EXPECT_EQ(tested.rig.state(), State::SafeOperational);
    EXPECT_THAT(tested.modes, ::testing::Each(DeviceMode::Off));
    EXPECT_THAT(tested.put_out, ::testing::Each(std::array{0.0, 0.0}));
  }
}

TEST(ManipulatorSelfTest, FindsSensorsThatCannotBeRightAtRest) {
  const auto found = [](auto defect) {
    Tested tested;
    tested.up();
    defect(tested);
    tested.cycle(2);
    return Tested::said(tested.self_test());
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(found([](Tested& arm) { arm.motor_rad_s[1] = 0.06; }), "it moves though nothing drives it, joint 2");
  EXPECT_EQ(found([](Tested& arm) { arm.joint_rad_s[0] = nan; }), "it moves though nothing drives it, joint 1");
  EXPECT_EQ(found([](Tested& arm) { arm.joint_rad[0] = arm.motor_rad[0] = -3.0; }),
            "measured outside of its range, joint 1");
  EXPECT_EQ(found([](Tested& arm) { arm.joint_rad[1] = nan; }), "measured outside of its range, joint 2");
  EXPECT_EQ(found([](Tested& arm) { arm.motor_rad[1] += 0.11; }), "motor and joint are measured apart, joint 2");
  EXPECT_EQ(found([](Tested& arm) { arm.load_n_m[0] = -12.0; }), "its load at rest is above its limit, joint 1");
  EXPECT_EQ(found([](Tested& arm) { arm.temperature_deg_c = 75; }), "too hot 0");
}

}  // namespace
}  // namespace hirosco
