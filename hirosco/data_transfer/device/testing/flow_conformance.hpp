// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"

/// What every DataFlow must do. `Traits` has: Factory; static FlowAddress address(), another one for each test where
/// the system keeps addresses; knows_its_peer (sees a hang-up without sending), and hands_on_in_pieces of a line.
namespace hirosco::testing {

template <class Traits>
class FlowConformance : public ::testing::Test {
 protected:
  static std::vector<std::byte> frame(std::size_t octets, int seed) {
    std::vector<std::byte> made(octets);
    for (std::size_t i = 0; i < octets; ++i) made[i] = static_cast<std::byte>(static_cast<int>(i) * 5 + seed);
    return made;
  }
  /// What the flow has within the time that an operating system may take to pass it on.
  Result<Received> await(DataFlow& flow) {
    (void)flow.wait(std::chrono::seconds{5});
    return flow.receive(buffer_);
  }
  void expect_frame(DataFlow& flow, Octets expected) {
    const auto received = await(flow);
    ASSERT_TRUE(received) << received.error().text << " " << received.error().value;
    ASSERT_EQ(received->flow, Flow::New);
    EXPECT_TRUE(std::ranges::equal(Octets{buffer_}.first(received->octets), expected));
  }
  std::unique_ptr<DataFlow> open(FlowSide side) {
    auto opened = factory_.open(address_, side);
    if (!opened) ADD_FAILURE() << opened.error().text << " " << opened.error().value;
    return opened ? std::move(*opened) : nullptr;
  }

  typename Traits::Factory factory_;
  FlowAddress address_ = Traits::address();
  std::unique_ptr<DataFlow> device_ = open(FlowSide::Device);
  std::unique_ptr<DataFlow> subsystem_ = open(FlowSide::Subsystem);
  std::array<std::byte, max_frame_octets> buffer_{};
};

TYPED_TEST_SUITE_P(FlowConformance);

TYPED_TEST_P(FlowConformance, FindsNothingWhereNothingWasSent) {
  EXPECT_EQ(this->subsystem_->receive(this->buffer_).value().flow, Flow::None);
  EXPECT_EQ(this->device_->receive(this->buffer_).value().flow, Flow::None);
}

TYPED_TEST_P(FlowConformance, KeepsTheBoundariesOfFramesBothWays) {
  for (const std::size_t octets : {std::size_t{1}, std::size_t{40}, max_frame_octets, std::size_t{3}}) {
    const auto command = this->frame(octets, 1);
    ASSERT_TRUE(this->subsystem_->send(command));
    this->expect_frame(*this->device_, command);
    const auto answer = this->frame(octets, 2);
    ASSERT_TRUE(this->device_->send(answer));
    this->expect_frame(*this->subsystem_, answer);
  }
  EXPECT_EQ(this->subsystem_->receive(this->buffer_).value().flow, Flow::None);
}

TYPED_TEST_P(FlowConformance, DeliversTheNewestFrameHoweverManyWait) {
  for (int i = 1; i <= 3; ++i) ASSERT_TRUE(this->subsystem_->send(this->frame(10, i)));
  const auto newest = this->frame(10, 3);
  bool came = false;
  for (int frames = 0; frames < 3 && !came; ++frames) {
    const auto received = this->await(*this->device_);
    ASSERT_TRUE(received);
    came = std::ranges::equal(Octets{this->buffer_}.first(received->octets), newest);
    // Until all of it is there, the newest is an older one.
    constexpr bool in_pieces = requires { TypeParam::hands_on_in_pieces; };
    EXPECT_TRUE(came || in_pieces);
  }
  EXPECT_TRUE(came);
  EXPECT_EQ(this->device_->receive(this->buffer_).value().flow, Flow::None);
}

TYPED_TEST_P(FlowConformance, RefusesAFrameThatIsTooLong) {
  EXPECT_EQ(this->subsystem_->send(this->frame(max_frame_octets + 1, 1)).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(this->device_->receive(this->buffer_).value().flow, Flow::None);
}

TYPED_TEST_P(FlowConformance, ReportsAFrameThatTheBufferCannotHoldAndGoesOn) {
  ASSERT_TRUE(this->subsystem_->send(this->frame(100, 1)));
  (void)this->device_->wait(std::chrono::seconds{5});
  std::array<std::byte, 99> small{};
  EXPECT_EQ(this->device_->receive(small).error().code, ErrorCode::Malformed);
  EXPECT_EQ(this->device_->receive(this->buffer_).value().flow, Flow::None);
  ASSERT_TRUE(this->subsystem_->send(this->frame(10, 2)));
  this->expect_frame(*this->device_, this->frame(10, 2));
}

TYPED_TEST_P(FlowConformance, WaitsForAFrame) {
  EXPECT_FALSE(this->device_->wait(1ms));
  ASSERT_TRUE(this->subsystem_->send(this->frame(10, 1)));
  EXPECT_TRUE(this->device_->wait(std::chrono::hours{1}));
  (void)this->device_->receive(this->buffer_);
  EXPECT_FALSE(this->device_->wait(0ns));
}

TYPED_TEST_P(FlowConformance, ReportsThatTheDeviceHasGone) {
  ASSERT_TRUE(this->subsystem_->send(this->frame(10, 1)));
  this->expect_frame(*this->device_, this->frame(10, 1));
  this->device_.reset();
  bool reported = false;
  for (int i = 0; i < 3 && !reported; ++i) {
    const auto received = this->subsystem_->receive(this->buffer_);
    reported = !received && received.error().code == ErrorCode::Unavailable;
    if (TypeParam::knows_its_peer) {
      EXPECT_TRUE(reported);
    } else if (!reported) {
      const auto sent = this->subsystem_->send(this->frame(10, 2));
      reported = !sent && sent.error().code == ErrorCode::Unavailable;
    }
  }
  EXPECT_TRUE(reported);
}

TYPED_TEST_P(FlowConformance, CarriesOnWithADeviceThatCameBack) {
  ASSERT_TRUE(this->subsystem_->send(this->frame(10, 1)));
  this->device_.reset();
  this->device_ = this->open(FlowSide::Device);
  ASSERT_TRUE(this->device_);
  EXPECT_EQ(this->device_->receive(this->buffer_).value().flow, Flow::None) << "frames for its predecessor are gone";
  // Who has to look for its peer does so once in a pause.
  while (!this->subsystem_->send(this->frame(11, 2))) (void)this->subsystem_->wait(1ms);
  this->expect_frame(*this->device_, this->frame(11, 2));
  ASSERT_TRUE(this->device_->send(this->frame(12, 3)));
  this->expect_frame(*this->subsystem_, this->frame(12, 3));
}

TYPED_TEST_P(FlowConformance, OpensASideOnce) {
  EXPECT_EQ(this->factory_.open(this->address_, FlowSide::Device).error().code, ErrorCode::AlreadyExists);
}

REGISTER_TYPED_TEST_SUITE_P(FlowConformance, FindsNothingWhereNothingWasSent, KeepsTheBoundariesOfFramesBothWays,
                            DeliversTheNewestFrameHoweverManyWait, RefusesAFrameThatIsTooLong,
                            ReportsAFrameThatTheBufferCannotHoldAndGoesOn, WaitsForAFrame, ReportsThatTheDeviceHasGone,
                            CarriesOnWithADeviceThatCameBack, OpensASideOnce);

}  // namespace hirosco::testing
