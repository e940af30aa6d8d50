// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <type_traits>

#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {
namespace {

using ::testing::ElementsAre;

Sandbox let_in_for(Transfer transfer, const std::string& address, const std::string& instance = "") {
  Sandbox sandbox;
  let_in({transfer, address}, instance, sandbox);
  return sandbox;
}
bool reaches(const Sandbox& sandbox, Transfer transfer, const std::string& address) {
  return is_reached({.transfer = transfer, .address = address, .holder = FlowHolder::Supervisor}, sandbox);
}

static_assert(!std::is_default_constructible_v<FlowAccess>, "a row that says nothing of it is not compiled");

TEST(FlowAccess, OfAMeansThatIsNotBuiltInLetsNobodyInAndIsTakenToBeReachedByAll) {
  ASSERT_EQ(find_flow_means(Transfer::Ethercat), nullptr);
  const Sandbox closed = let_in_for(Transfer::Ethercat, "eth1");
  EXPECT_TRUE(closed.writable.empty() && closed.readable.empty() && closed.executable.empty());
  EXPECT_EQ(closed.sockets, SandboxSockets{});
  EXPECT_FALSE(closed.queues);
  EXPECT_TRUE(reaches(closed, Transfer::Ethercat, "eth1"));
  EXPECT_TRUE(make_place({Transfer::Ethercat, "eth1"}, ""));
}

TEST(FlowAccess, OfEachMeansLetsInForSomethingAndOutOfASandboxWithNothingInItNothingIsReached) {
  for (const FlowMeans& means : standard_flow_means()) {
    const std::string address = means.form == AddressForm::HostPort ? "127.0.0.1:5000" : "arm";
    const Sandbox open = let_in_for(means.transfer, address);
    EXPECT_TRUE(!open.writable.empty() || open.queues || open.sockets != SandboxSockets{}) << to_text(means.transfer);
    EXPECT_FALSE(reaches(Sandbox{}, means.transfer, address)) << to_text(means.transfer) << " reaches out of nothing";
  }
}

TEST(FlowAccess, OfAUnixSocketIsToTheFolderThatItIsInAndReachesAllOfThem) {
  const Sandbox open = let_in_for(Transfer::Unix, "/run/arm/socket");
  EXPECT_THAT(open.writable, ElementsAre("/run/arm"));
  EXPECT_EQ(open.sockets, (SandboxSockets{.local = true}));
  EXPECT_TRUE(reaches(open, Transfer::Unix, "/elsewhere/socket"));
  EXPECT_EQ(let_in_for(Transfer::Unix, "").sockets, SandboxSockets{}) << "an address that is none";
}

TEST(FlowAccess, OfUdpReachesAllThatListensInThisComputer) {
  const Sandbox open = let_in_for(Transfer::Udp, "127.0.0.1:5000");
  EXPECT_EQ(open.sockets, (SandboxSockets{.datagrams = true}));
  EXPECT_TRUE(reaches(open, Transfer::Udp, "127.0.0.1:5001"));
  EXPECT_FALSE(reaches(open, Transfer::Udp, "192.0.2.7:5001")) << "beyond this computer";
  EXPECT_FALSE(reaches(open, Transfer::Udp, "nowhere"));
}

TEST(FlowAccess, IsToAFileAndToAllBelowAFolderAndNotToWhatOnlyBeginsWithItsName) {
  Sandbox open;
  let_write("/dev/pts", open);
  let_write("/dev/pts", open);
  EXPECT_THAT(open.writable, ElementsAre("/dev/pts"));
  EXPECT_TRUE(may_write("/dev/pts", open));
  EXPECT_TRUE(may_write("/dev/pts/3", open));
  EXPECT_FALSE(may_write("/dev/pts3", open));
  EXPECT_FALSE(may_write("/dev", open));
}

}  // namespace
}  // namespace hirosco
