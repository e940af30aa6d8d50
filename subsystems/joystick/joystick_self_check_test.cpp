// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "subsystems/joystick/joystick.hpp"

/// What the joystick's self test keeps from a hand before anything pushes.
namespace hirosco {
namespace {

/// joystick.xml, whose configuration STANDALONE requires the self test.
std::string wary_joystick() {
  std::string text = descriptor::file_system()(HIROSCO_SOURCE_DIR "/subsystems/joystick/joystick.xml").value();
  const std::string before = R"(<Configuration name="STANDALONE" id="1")";
  return text.replace(text.find(before), before.size(), before + R"( self_test="required")");
}

/// The test plays a handle that nobody moves.
struct TestedJoystick {
  explicit TestedJoystick(joystick::Law law = joystick::display_law) : joystick{make_joystick_with(law)} {}
  std::unique_ptr<Subsystem> joystick;
  testing::Rig rig{*joystick, wary_joystick()};
  std::unique_ptr<DataFlow> handle =
      std::move(rig.flows.open({Transfer::SharedMemory, "joystick-handle"}, FlowSide::Device)).value();
  std::array<double, 2> position_rad{};
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
    const auto found = handle->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    modes.push_back(command.mode);
    OctetReader reader{command.payload, std::endian::little};
    const double first = reader.get<double>();
    put_out.push_back({first, reader.get<double>()});
    std::array<std::byte, 34> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(position_rad[0]).put(position_rad[1]).put(0.0).put(0.0);
    writer.put(std::uint8_t{0}).put(std::uint8_t{1});  // a simulated hand, and no other
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload});
    static_cast<void>(handle->send(status.value()));
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
  std::string self_test() { return after(rig.send(17, 128, {}), 10); }
  std::string operational() { return after(rig.set_state(State::Operational), 4); }
};

[[nodiscard]] bool says(const std::string& outcome, const std::string& words) {
  return outcome.find(testing::hex(std::as_bytes(std::span{words}))) != std::string::npos;
}

TEST(JoystickSelfTest, PassesInAFewCyclesAndPushesNobody) {
  TestedJoystick tested;
  tested.up();
  EXPECT_EQ(tested.operational().substr(0, 8), "1 4:010a") << "it has not passed yet";
  EXPECT_EQ(tested.self_test(), "1 3 7");
  EXPECT_THAT(tested.modes, ::testing::Each(DeviceMode::Off));
  EXPECT_THAT(tested.put_out, ::testing::Each(std::array{0.0, 0.0}));
  EXPECT_EQ(tested.operational(), "1 3 7");
  EXPECT_EQ(tested.modes.back(), DeviceMode::Active);
  EXPECT_EQ(tested.put_out.back(), (std::array{0.0, 0.0}));
}

TEST(JoystickSelfTest, KeepsAForceOfTheWrongSignAndAHandleOutsideOfItsRangeFromOperational) {
  TestedJoystick reversed{
      [](joystick::DisplayLaw& law, const joystick::DisplayLaw::Input& input, double scale) noexcept {
        joystick::Axes torque = law.torque(input, scale);
        for (double& each : torque) each = -each;
        return torque;
      }};
  TestedJoystick astray;
  astray.position_rad[1] = 0.6;
  for (const auto& [tested, words] : {std::pair{&reversed, "it would not push against what the robot presses on, axis"},
                                      std::pair{&astray, "measured outside of its range, axis"}}) {
    tested->up();
    EXPECT_TRUE(says(tested->self_test(), words)) << words;
    const std::string refused = tested->operational();
    EXPECT_EQ(refused.substr(0, 8), "1 4:010a");
    EXPECT_TRUE(says(refused, words)) << "with the reason";
    EXPECT_EQ(tested->rig.state(), State::SafeOperational);
    EXPECT_THAT(tested->modes, ::testing::Each(DeviceMode::Off));
    EXPECT_THAT(tested->put_out, ::testing::Each(std::array{0.0, 0.0}));
  }
}

/// What is tried is what the descriptor lets come about, and no less.
TEST(JoystickSelfTest, GoesByTheRangesThatTheDescriptorHas) {
  const auto reading =
      descriptor::read_subsystem(HIROSCO_SOURCE_DIR "/subsystems/joystick/joystick.xml", descriptor::file_system());
  ASSERT_TRUE(reading.value);
  const auto expect_range = [](const descriptor::Field& field, double most) {
    EXPECT_EQ(field.minimum, Number{-most}) << field.name;
    EXPECT_EQ(field.maximum, Number{most}) << field.name;
  };
  const auto* hand = reading.value->find_function("HAND");
  const auto* display = reading.value->find_function("DISPLAY_TORQUE");
  ASSERT_TRUE(hand != nullptr && display != nullptr);
  for (const auto& angle : hand->arguments) expect_range(angle.field, joystick::SelfCheck::range_rad);
  for (const auto& torque : display->arguments) expect_range(torque.field, joystick::DisplayLaw::torque_max_n_m);
  const auto output =
      std::ranges::find(reading.value->devices[0].output, "TORQUE", [](const auto& each) { return each.field.name; });
  ASSERT_NE(output, reading.value->devices[0].output.end());
  expect_range(output->field, joystick::DisplayLaw::torque_max_n_m);
  const auto scale =
      std::ranges::find(reading.value->parameters, "FORCE_SCALE", [](const auto& each) { return each.field.name; });
  ASSERT_NE(scale, reading.value->parameters.end());
  EXPECT_EQ(scale->field.minimum, Number{0.0});
  EXPECT_EQ(scale->field.maximum, Number{joystick::SelfCheck::most_scale});
}

}  // namespace
}  // namespace hirosco
