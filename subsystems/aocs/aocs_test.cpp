// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/aocs/aocs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "hirosco/subsystem/testing/tried_functions.hpp"

namespace hirosco {
namespace {

constexpr std::uint8_t station_keeping = 1, free_float = 2;
constexpr std::uint16_t attitude_settled = 2001, wheels_unloaded = 2002, wheels_full = 2010, wheels_too_full = 2011;

/// The test plays the base: wheels and sensors.
struct AocsTest : ::testing::Test {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/aocs/aocs.xml"};
  std::unique_ptr<Subsystem> aocs = make_aocs();
  testing::Rig rig{*aocs, descriptor::file_system()(file).value()};
  std::unique_ptr<DataFlow> wheels = open("aocs-wheels"), sensors = open("aocs-sensors");
  std::array<double, 3> stored_n_m_s{}, rate_rad_s{};
  std::array<double, 4> orientation{1, 0, 0, 0};
  std::array<double, 6> torque{};  ///< of wheels and thrusters
  std::optional<DeviceMode> mode;  ///< of the wheels; nothing: nobody speaks to them

  std::unique_ptr<DataFlow> open(const char* address) {
    return std::move(rig.flows.open({Transfer::SharedMemory, address}, FlowSide::Device)).value();
  }
  void answer(DataFlow& flow, std::uint32_t sequence, std::span<const double> numbers) {
    std::array<std::byte, max_device_payload_octets> payload{};
    OctetWriter writer{payload, std::endian::little};
    for (const double number : numbers) writer.put(number);
    std::array<std::byte, max_device_frame_octets> frame{};
    static_cast<void>(
        flow.send(write_status(frame, {.epoch = 1, .sequence = sequence, .payload = writer.written()}).value()));
  }
  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    if (const auto found = wheels->receive(frame); found && found->flow == Flow::New) {
      const auto command = read_command(Octets{frame}.first(found->octets)).value();
      mode = command.mode;
      OctetReader reader{command.payload, std::endian::little};
      for (double& each : torque) each = reader.get<double>();
      answer(*wheels, command.sequence, stored_n_m_s);
    }
    if (const auto found = sensors->receive(frame); found && found->flow == Flow::New) {
      const auto command = read_command(Octets{frame}.first(found->octets)).value();
      std::array<double, 13> told{};
      std::ranges::copy(orientation, told.begin() + 3);
      std::ranges::copy(rate_rad_s, told.begin() + 7);
      answer(*sensors, command.sequence, told);
    }
  }
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange();
    }
    rig.service();
  }
  void operate(std::uint8_t configuration) {
    rig.bring_to(State::PreOperational, configuration);
    cycle(5);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = rig.set_state(state);
      cycle(5);
      ASSERT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
    }
  }
  std::string now(std::string_view function, std::initializer_list<double> arguments = {}) {
    const auto request = rig.call(function, arguments);
    cycle(3);
    return rig.outcome(request);
  }
};

TEST_F(AocsTest, TurnsTheBaseBackToItsReference) {
  operate(station_keeping);
  orientation = {std::cos(0.005), std::sin(0.005), 0, 0};  // 10 mrad about x
  rate_rad_s = {0, 0.001, 0};
  cycle(3);
  EXPECT_NEAR(torque[0], -0.06, 1e-9);
  EXPECT_NEAR(torque[1], -0.06, 1e-9);
  EXPECT_EQ(torque[3], 0) << "thrusters are for emptying wheels";
  EXPECT_EQ(mode, DeviceMode::Active);
}

TEST_F(AocsTest, FloatingFreeItDoesNotEvenSpeakToItsWheels) {
  operate(free_float);
  orientation = {std::cos(0.1), std::sin(0.1), 0, 0};
  cycle(20);
  EXPECT_FALSE(mode);
  EXPECT_EQ(now("DESATURATE").substr(0, 8), "1 4:8002");
}

TEST_F(AocsTest, WhatFunctionsSayThatTheySetTheySet) {
  operate(station_keeping);
  const testing::TriedFunctions functions{rig, [this] { cycle(); }, [this] { cycle(3); }};
  EXPECT_THAT(functions.untold(), ::testing::IsEmpty());
  EXPECT_THAT(functions.idle(), ::testing::IsEmpty());
}

TEST_F(AocsTest, TellsOnceThatItHasSettled) {
  operate(station_keeping);
  cycle(120);
  EXPECT_EQ(rig.heard(attitude_settled), 1);
  orientation = {std::cos(0.005), std::sin(0.005), 0, 0};
  cycle(5);
  orientation = {1, 0, 0, 0};
  cycle(120);
  EXPECT_EQ(rig.heard(attitude_settled), 2);
}

TEST_F(AocsTest, KeepsTheAttitudeThatItIsTold) {
  operate(station_keeping);
  EXPECT_EQ(now("POINT_TO", {0, 0, 0, 0}).substr(0, 8), "1 4:8001");
  orientation = {std::cos(0.2), 0, 0, std::sin(0.2)};
  cycle(2);
  EXPECT_EQ(now("POINT_HERE"), "1 3 7");
  cycle(2);
  EXPECT_NEAR(torque[2], 0, 1e-9);
}

TEST_F(AocsTest, TellsWheelsThatFillUpAndEmptiesThemAgainstTheThrusters) {
  operate(station_keeping);
  stored_n_m_s = {0, 7, 0};
  cycle(4);
  EXPECT_EQ(rig.heard(wheels_full), 1);
  EXPECT_EQ(rig.heard(wheels_too_full), 0);
  stored_n_m_s = {0, 7.7, 0};
  cycle(4);
  EXPECT_EQ(rig.heard(wheels_too_full), 1);
  const auto request = rig.call("DESATURATE", {});
  cycle(5);
  EXPECT_EQ(rig.outcome(request), "1 3");
  EXPECT_NEAR(torque[1], 0.25, 1e-9) << "towards empty: the base gets what the wheel gives";
  EXPECT_NEAR(torque[4], -0.25, 1e-9) << "and the opposite of thrusters";
  stored_n_m_s = {};
  cycle(5);
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  EXPECT_EQ(rig.heard(wheels_unloaded), 1);
}

}  // namespace
}  // namespace hirosco
