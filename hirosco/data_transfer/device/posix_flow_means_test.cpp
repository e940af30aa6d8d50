// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <unistd.h>

#include "hirosco/data_transfer/device/datagram_flow.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/testing/flow_conformance.hpp"
#include "hirosco/data_transfer/link/link.hpp"

namespace hirosco::testing {
namespace {

TEST(PosixMeans, AreDatagramsAndWhatTheyLackIsRefusedByItsWord) {
  EXPECT_NE(find_flow_means(Transfer::Unix), nullptr);
  EXPECT_NE(find_flow_means(Transfer::Udp), nullptr);
  EXPECT_EQ(find_flow_means(Transfer::SharedMemory), nullptr);
}

TEST(PosixMeans, ADeviceIsReachedByAUnixSocketAndWaitedFor) {
  const std::string path = ::testing::TempDir() + "posix_means." + std::to_string(::getpid());
  const auto device = open_unix_flow(path, FlowSide::Device).value();
  const auto subsystem = open_unix_flow(path, FlowSide::Subsystem).value();
  EXPECT_FALSE(device->wait(1ms));
  ASSERT_TRUE(subsystem->send(std::array{std::byte{7}}));
  EXPECT_TRUE(device->wait(1h));
  std::array<std::byte, 8> frame{};
  EXPECT_EQ(device->receive(frame).value().octets, 1U);
  EXPECT_EQ(frame[0], std::byte{7});
}

TEST(PosixMechanisms, AreThoseOfOneProcess) {
  EXPECT_EQ(standard_link_mechanisms().data(), local_link_mechanisms().data());
  EXPECT_NE(find_link_mechanism(standard_link_mechanisms(), LinkMethod::SharedMemory, LinkKind::Latest), nullptr);
}

}  // namespace
}  // namespace hirosco::testing
