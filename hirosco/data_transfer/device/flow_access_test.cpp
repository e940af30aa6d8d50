// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"

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

TEST(FlowAccess, OfAUserOfItsOwnIsAPartOfThatWhereAllAreOfOneUser) {
  for (const FlowMeans& means : standard_flow_means()) {
    const FlowAddress at{means.transfer, means.form == AddressForm::HostPort ? "127.0.0.1:5000" : "/dev/arm"};
    if (!why_not_own(at).empty()) continue;
    Sandbox own;
    let_in(at, "", own, ProcessUser::ItsOwn);
    const Sandbox open = let_in_for(at.transfer, at.address);
    for (const std::string& place : own.writable) EXPECT_TRUE(may_write(place, open)) << place;
    EXPECT_EQ(own.sockets, open.sockets) << to_text(means.transfer);
    EXPECT_TRUE(own.queues == open.queues && own.readable == open.readable) << to_text(means.transfer);
  }
}

TEST(FlowAccess, OfAUserOfItsOwnToAUnixSocketIsToAFolderOfItsAddressWhichIsMadeBeforeTheFlightAlone) {
  std::string root = (std::filesystem::temp_directory_path() / "hirosco-own-XXXXXX").string();
  ASSERT_NE(::mkdtemp(root.data()), nullptr);
  const FlowAddress at{Transfer::Unix, root + "/arm"};
  const std::string folder = root + "/arm.twin";
  EXPECT_EQ(own_folder(at, "twin"), folder);
  Sandbox own;
  let_in(at, "twin", own, ProcessUser::ItsOwn);
  EXPECT_THAT(own.writable, ElementsAre(folder));
  EXPECT_EQ(own.sockets, (SandboxSockets{.local = true}));
  const OwnGroup group{.group = ::getegid()};
  EXPECT_TRUE(make_own_place(at, "twin", group, PlaceTime::AtStart));
  EXPECT_FALSE(std::filesystem::exists(folder)) << "no disk is asked in flight";
  EXPECT_TRUE(make_own_place(at, "twin", group, PlaceTime::BeforeFlight));
  EXPECT_TRUE(is_private_folder(folder, group.group));
  std::ofstream{folder + "/socket"};
  remove_place(at, "twin", ProcessUser::ItsOwn);
  EXPECT_TRUE(std::filesystem::exists(folder)) << "somebody is in it";
  std::filesystem::remove(folder + "/socket");
  remove_place(at, "twin", ProcessUser::ItsOwn);
  EXPECT_FALSE(std::filesystem::exists(folder));
  std::filesystem::remove_all(root);
  EXPECT_EQ(own_folder({Transfer::Unix, ""}, ""), "") << "an address that is none";
}

TEST(FlowAccess, OfAMeansThatSaysNothingOfAUserOfItsOwnIsNobodysAndLetsNobodyIn) {
  const FlowAddress at{Transfer::Ethercat, "eth1"};
  EXPECT_EQ(why_not_own(at), "by ethercat nothing is known of whose it is");
  EXPECT_EQ(make_own_place(at, "", {}, PlaceTime::BeforeFlight).error().code, ErrorCode::NotPermitted);
  Sandbox own;
  let_in(at, "", own, ProcessUser::ItsOwn);
  EXPECT_TRUE(own.writable.empty());
  remove_place(at, "", ProcessUser::ItsOwn);
  EXPECT_EQ(own_folder(at, ""), "");
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
