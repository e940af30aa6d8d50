// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "subsystems/manipulator/manipulator.hpp"

/// One class, arms with 1, 2, 6 and 7 joints: what differs between them is
/// their descriptor.
namespace hirosco {
namespace {

using pus::st128::Role;
using ::testing::Each;
using ::testing::HasSubstr;

/// So many joints differ from each other; behind them it begins anew, within their limits.
constexpr std::size_t different = 7;

/// testdata/arm.xml with another number of joints.
std::string arm_descriptor(std::size_t joints) {
  std::string text = descriptor::file_system()(HIROSCO_SOURCE_DIR "/subsystems/manipulator/testdata/arm.xml").value();
  const auto replace_all = [&text](const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  std::string home, safe;
  for (std::size_t i = 1; i <= joints; ++i) {
    home += " 0." + std::to_string((i - 1) % different + 1);
    safe += " 0";
  }
  replace_all("0.1 0.2 0.3 0.4 0.5 0.6", home.substr(1));
  replace_all("0 0 0 0 0 0", safe.substr(1));
  replace_all("count=\"6\"", "count=\"" + std::to_string(joints) + "\"");
  const auto line_of = [&text](std::size_t joint) {
    const auto begin = text.find("      <Argument name=\"Q" + std::to_string(joint) + "\"");
    return std::pair{begin, text.find('\n', begin) + 1 - begin};
  };
  for (std::size_t joint = 6; joint > joints; --joint) text.erase(line_of(joint).first, line_of(joint).second);
  for (std::size_t joint = 7; joint <= joints; ++joint) {
    const auto [begin, length] = line_of(joint - 1);
    std::string line = text.substr(begin, length);
    line.replace(line.find('Q') + 1, std::to_string(joint - 1).size(), std::to_string(joint));
    text.insert(begin + length, line);
  }
  return text;
}

/// The test plays the arm: each joint is a motor that moves freely, and its
/// sensor tells the load that it is given.
struct ArmTest : ::testing::TestWithParam<std::size_t> {
  static constexpr double motor_inertia_kg_m2 = 1.28, cycle_s = 0.0005;

  std::size_t n = GetParam();
  std::unique_ptr<Subsystem> arm = make_arm();
  testing::Rig rig{*arm, arm_descriptor(n)};
  std::unique_ptr<DataFlow> device =
      std::move(rig.flows.open({Transfer::SharedMemory, "arm"}, FlowSide::Device)).value();
  testing::Rig::Partner handle;
  std::vector<double> handle_rad = std::vector<double>(n);
  std::vector<double> position_rad, speed_rad_s = std::vector<double>(n), load_n_m = std::vector<double>(n);
  std::vector<double> commanded_n_m = std::vector<double>(n);
  double largest_n_m{0};
  std::uint8_t tool{0};
  DeviceMode mode{};
  std::vector<std::vector<double>> path; ///< of every cycle

  void SetUp() override {
    for (std::size_t i = 0; i < n; ++i)
      position_rad.push_back(0.1 * static_cast<double>(i % different + 1));  // at home
  }

  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      if (handle.writer) sample_handle();
      rig.service();
      rig.cycle();
      exchange();
      path.push_back(position_rad);
    }
    rig.service();
  }
  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = device->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    mode = command.mode;
    ASSERT_EQ(command.payload.size(), 8 * n + 1);
    OctetReader reader{command.payload, std::endian::little};
    for (std::size_t i = 0; i < n; ++i) {
      commanded_n_m[i] = reader.get<double>();
      largest_n_m = std::max(largest_n_m, std::abs(commanded_n_m[i]));
      // Off, a brake holds it.
      speed_rad_s[i] = mode == DeviceMode::Active
                           ? speed_rad_s[i] + (commanded_n_m[i] - load_n_m[i]) / motor_inertia_kg_m2 * cycle_s
                           : 0.0;
      position_rad[i] += speed_rad_s[i] * cycle_s;
    }
    tool = reader.get<std::uint8_t>();
    std::vector<std::byte> payload(5 * 8 * n + 4 * n + 1);
    OctetWriter writer{payload, std::endian::little};
    for (const auto* numbers : {&position_rad, &speed_rad_s, &position_rad, &speed_rad_s, &load_n_m})
      for (const double number : *numbers) writer.put(number);
    for (std::size_t i = 0; i < n; ++i) writer.put(20.0F);
    writer.put(std::uint8_t{0});
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload});
    static_cast<void>(device->send(status.value()));
  }
  void sample_handle() {
    std::vector<std::byte> payload(16 * n + 1);
    OctetWriter writer{payload, std::endian::little};
    for (const double angle : handle_rad) writer.put(angle);
    for (std::size_t i = 0; i < n; ++i) writer.put(0.0);
    writer.put(std::uint8_t{1});
    handle.writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  }
  void command(State state) {
    const auto request = rig.set_state(state);
    cycle(5);
    EXPECT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
  }
  void operate(std::uint8_t configuration = 1) {
    rig.bring_to(State::PreOperational, configuration);
    const auto count = static_cast<std::uint16_t>(n);
    if (configuration == 2)
      handle =
          rig.attach(1, Role::Consumer, "HANDLE_STATE",
                     {{"POSITION", Type::Double, count}, {"VELOCITY", Type::Double, count}, {"ENABLE", Type::Uint8, 1}},
                     nullptr, 500us);
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
    ASSERT_EQ(rig.inhibited(), 0u);
    ASSERT_EQ(mode, DeviceMode::Active);
  }
  testing::Sent move_to(const std::vector<double>& goal_rad, double duration_s) {
    std::vector<double> numbers = goal_rad;
    numbers.push_back(duration_s);
    const auto data = pus::encode_call(*rig.descriptor().find_function("MOVE_TO"), numbers).value();
    std::vector<std::byte> octets(data.begin(), data.end());
    return rig.send(8, 1, octets);
  }
  /// Every joint another way, of another sign than its neighbours'.
  [[nodiscard]] std::vector<double> elsewhere() const {
    std::vector<double> goal = position_rad;
    for (std::size_t i = 0; i < n; ++i) goal[i] += (i % 2 == 0 ? -0.1 : 0.08) * static_cast<double>(i % different + 1);
    return goal;
  }
  void expect_at(const std::vector<double>& where_rad, double tolerance_rad) const {
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(position_rad[i], where_rad[i], tolerance_rad) << "joint " << i + 1;
  }
};

TEST_P(ArmTest, HoldsItsPositionWhereverItStandsAndComesBackToIt) {
  position_rad[n - 1] -= 0.3;
  const auto where = position_rad;
  operate();
  cycle(200);
  expect_at(where, 1e-6);
  for (std::size_t i = 0; i < n; ++i) {
    position_rad[i] += 0.01;
    cycle(2000);
    expect_at(where, 1e-4);
  }
}

TEST_P(ArmTest, MovesAllJointsInStepAndIsDoneWhenAllAreMeasuredAtTheGoal) {
  operate();
  const auto from = position_rad, goal = elsewhere();
  path.clear();
  const auto request = move_to(goal, 2.0);
  cycle(2010);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001");
  cycle(2200);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001 7");
  EXPECT_EQ(rig.events(1001), 1);
  expect_at(goal, 0.005);
  for (const auto& at : path) {
    const double share = (at[0] - from[0]) / (goal[0] - from[0]);
    for (std::size_t i = 1; i < n; ++i)
      ASSERT_NEAR((at[i] - from[i]) / (goal[i] - from[i]), share, 0.02) << "joint " << i + 1;
  }
}

TEST_P(ArmTest, RefusesWhatItsLongestWayIsTooFarForAndWhatOneJointCannotReach) {
  operate();
  auto goal = position_rad;
  goal[n - 1] -= 1.0;
  auto request = move_to(goal, 1.8);
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 4:8002") << "1 rad takes 1.875 s at 1 rad/s";
  request = move_to(goal, 1.9);
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 3");
}

TEST_P(ArmTest, GoesHomeToTheInitialValueOfItsDescriptor) {
  const auto home = position_rad;
  for (double& position : position_rad) position -= 0.2;
  operate();
  const auto request = rig.call("HOME");
  cycle(6200);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001 7");
  expect_at(home, 0.005);
}

TEST_P(ArmTest, LimitsTheTorqueOfEachJoint) {
  operate();
  for (std::size_t loaded = 0; loaded < n; ++loaded) {
    rig.forget_telemetry();
    load_n_m[loaded] = 13;
    cycle(6);
    EXPECT_EQ(rig.inhibited(), inhibited_by_author) << "joint " << loaded + 1;
    EXPECT_EQ(mode, DeviceMode::Off);
    EXPECT_THAT(commanded_n_m, Each(0.0));
    const auto told = std::ranges::find(rig.raised, 1020, &testing::Raised::id);
    ASSERT_NE(told, rig.raised.end());
    EXPECT_EQ(std::to_integer<std::size_t>(told->auxiliary[0]), loaded + 1);
    load_n_m[loaded] = 0;
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
  }
  EXPECT_LE(largest_n_m, 60);
}

TEST_P(ArmTest, StopsWhenItIsToldToAndWhenItLeavesOperational) {
  operate();
  const auto first = move_to(elsewhere(), 2.0);
  cycle(1000);
  const auto stop = rig.call("HOLD");
  cycle(3);
  EXPECT_EQ(rig.outcome(stop), "1 3 7");
  EXPECT_EQ(rig.outcome(first), "1 3 8:0204");
  cycle(1000);
  const auto where = position_rad;
  cycle(1000);
  expect_at(where, 1e-4);
  const auto second = move_to(elsewhere(), 2.0);
  cycle(1000);
  command(State::SafeOperational);
  EXPECT_EQ(rig.outcome(second), "1 3 8:0204");
  EXPECT_EQ(mode, DeviceMode::Off);
  EXPECT_THAT(commanded_n_m, Each(0.0));
}

TEST_P(ArmTest, FollowsAHandleWithAsManyAxesFromWhereItStands) {
  operate(2);
  const auto from = position_rad;
  cycle(200);
  expect_at(from, 1e-6);
  auto goal = from;
  for (std::size_t axis = 0; axis < n; ++axis) {
    handle_rad[axis] = 0.05;
    goal[axis] += 0.05;
    cycle(1000);
    expect_at(goal, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, ArmTest, ::testing::Values(1, 2, 6, 7, 16));

TEST(ArmDescriptor, WhoseArraysDifferInLengthIsRefusedByName) {
  std::string text = arm_descriptor(6);
  const std::string handle = R"(<ParamRef name="HANDLE" id="111" type="DOUBLE" count="6")";
  text.replace(text.find(handle), handle.size(), R"(<ParamRef name="HANDLE" id="111" type="DOUBLE" count="5")");
  const auto arm = make_arm();
  testing::Rig rig{*arm, text};
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_THAT(rig.configure_now(1), ::testing::StartsWith("1 3 8:"));
  EXPECT_THAT(rig.explanations, ::testing::Contains(HasSubstr("CLUTCH.HANDLE has another length than DES_POSITION")));
}

TEST(ArmDescriptor, WithMoreJointsThanAnArmCanHaveIsRefusedByName) {
  std::string text = arm_descriptor(16);
  const std::string velocity = R"(name="DES_VELOCITY" id="2" type="DOUBLE" count=")";
  text.replace(text.find(velocity), velocity.size() + 2, velocity + "17");
  const auto arm = make_arm();
  testing::Rig rig{*arm, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_THAT(rig.explanations,
              ::testing::Contains(HasSubstr("DES_VELOCITY: the C++ type is Sized<double, 16>, the "
                                            "descriptor declares DOUBLE[17], which are more than 16")));
}

TEST(ArmDescriptor, WhoseMoveToNamesAnotherNumberOfJointsIsRefused) {
  std::string text = arm_descriptor(6);
  const auto begin = text.find("      <Argument name=\"Q6\"");
  text.erase(begin, text.find('\n', begin) + 1 - begin);
  const auto arm = make_arm();
  testing::Rig rig{*arm, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_THAT(rig.explanations, ::testing::Contains(HasSubstr("MOVE_TO takes a number for each element")));
}

} // namespace
} // namespace hirosco
