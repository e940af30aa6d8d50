// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "hirosco/data_transfer/device/frame_protocol.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"

namespace hirosco {
namespace {

/// One octet each way: the mode out, a value that is its own complement's neighbour in. Says more than it may when told to.
struct OctetProtocol final : FrameProtocol {
  int restarts{0};
  std::size_t said{1};
  std::byte value{};
  std::size_t say(const DeviceCommand& command, MutableOctets out) noexcept override {
    out[0] = static_cast<std::byte>(command.mode);
    return said;
  }
  Heard hear(Octets came) noexcept override {
    Heard heard;
    for (const std::byte each : came) {
      if (each == std::byte{0xFF}) ++heard.damaged;
      else value = each, heard.whole = true;
    }
    heard.flags = device_flag::over_temperature;
    heard.payload = {&value, 1};
    return heard;
  }
  void restart() noexcept override { ++restarts; }
};

struct RawFlow : ::testing::Test {
  LocalFlows flows;
  FlowAddress address{Transfer::Serial, "line", Framing::Raw};
  std::unique_ptr<DataFlow> device = flows.open(address, FlowSide::Device).value();
  OctetProtocol protocol;
  std::unique_ptr<DataFlow> flow = make_raw_flow(flows.open(address, FlowSide::Subsystem).value(), protocol);
  std::array<std::byte, max_frame_octets> buffer{};

  void command(DeviceMode mode, std::uint32_t sequence) {
    std::array<std::byte, max_frame_octets> frame;
    ASSERT_TRUE(
        flow->send(write_command(frame, {.mode = mode, .epoch = 7, .sequence = sequence, .payload = {}}).value()));
  }
  void say(std::initializer_list<int> octets) {
    std::vector<std::byte> wire;
    for (const int each : octets) wire.push_back(static_cast<std::byte>(each));
    ASSERT_TRUE(device->send(wire));
  }
};

TEST_F(RawFlow, GoesOutInTheProtocolsOctetsAndNothingElse) {
  command(DeviceMode::Stop, 1);
  EXPECT_EQ(device->receive(buffer).value().octets, 1U);
  EXPECT_EQ(buffer[0], std::byte{2});
  protocol.said = 0;
  command(DeviceMode::Active, 2);
  EXPECT_EQ(device->receive(buffer).value().flow, Flow::None) << "it had nothing to say";
  protocol.said = 100'000;
  command(DeviceMode::Active, 3);
  EXPECT_EQ(device->receive(buffer).value().octets, max_frame_octets) << "no more than there is";
}

TEST_F(RawFlow, AWholeMessageAnswersTheNewestCommand) {
  command(DeviceMode::Active, 41);
  command(DeviceMode::Active, 42);
  say({5, 6});
  const auto received = flow->receive(buffer).value();
  ASSERT_EQ(received.flow, Flow::New);
  const DeviceStatus status = read_status(Octets{buffer}.first(received.octets)).value();
  EXPECT_EQ(status.sequence, 42U);
  EXPECT_EQ(status.epoch, 7U);
  EXPECT_EQ(status.flags, device_flag::over_temperature);
  ASSERT_EQ(status.payload.size(), 1U);
  EXPECT_EQ(status.payload[0], std::byte{6});
  EXPECT_EQ(flow->receive(buffer).value().flow, Flow::None);
}

TEST_F(RawFlow, CountsWhatTheProtocolFoundDamaged) {
  say({0xFF, 0xFF});
  const auto received = flow->receive(buffer).value();
  EXPECT_EQ(received.flow, Flow::None);
  EXPECT_EQ(received.damaged, 2U);
}

TEST_F(RawFlow, AProtocolBeginsAnewWithEachConnection) {
  say({1});
  ASSERT_TRUE(flow->receive(buffer));
  EXPECT_EQ(protocol.restarts, 1);
  device.reset();
  EXPECT_EQ(flow->receive(buffer).error().code, ErrorCode::Unavailable);
  device = flows.open(address, FlowSide::Device).value();
  say({1});
  ASSERT_TRUE(flow->receive(buffer));
  EXPECT_EQ(protocol.restarts, 2);
}

TEST_F(RawFlow, SendsNothingThatIsNoCommand) {
  EXPECT_EQ(flow->send(std::array{std::byte{1}}).error().code, ErrorCode::Malformed);
  EXPECT_EQ(device->receive(buffer).value().flow, Flow::None);
}

}  // namespace
}  // namespace hirosco
