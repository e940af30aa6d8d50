// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"

/// What the means that need Linux ask of a sandbox, and what they reach by it.
namespace hirosco {
namespace {

using ::testing::ElementsAre;

Sandbox open_for(Transfer transfer, const std::string& address, const std::string& instance = "") {
  Sandbox sandbox;
  let_in({transfer, address}, instance, sandbox);
  return sandbox;
}
bool is_held_reached(Transfer transfer, const std::string& address, const Sandbox& sandbox) {
  return is_reached({.transfer = transfer, .address = address, .holder = FlowHolder::Supervisor}, sandbox);
}

TEST(LinuxFlowAccess, OfSharedMemoryIsToTheFolderOfItsFramesInItsOwnFlightAndReachesNothingOfTheSupervisors) {
  const Sandbox open = open_for(Transfer::SharedMemory, "arm", "twin");
  EXPECT_THAT(open.writable, ElementsAre("/dev/shm/hirosco/arm.twin"));
  EXPECT_EQ(open.sockets, SandboxSockets{});
  EXPECT_FALSE(is_held_reached(Transfer::SharedMemory, "arm", open));
  Sandbox in_memory;
  in_memory.writable = {"/dev/shm"};
  EXPECT_TRUE(is_held_reached(Transfer::SharedMemory, "arm", in_memory))
      << "as where a flight has its UNIX sockets there";
}

TEST(LinuxFlowAccess, OfALineIsToThatLineAndOfANameToAllPseudoTerminals) {
  const Sandbox line = open_for(Transfer::Serial, "/dev/ttyS0@115200"), named = open_for(Transfer::Serial, "arm@9600");
  EXPECT_THAT(line.writable, ElementsAre("/dev/ttyS0"));
  EXPECT_THAT(named.writable, ElementsAre("/dev/pts"));
  EXPECT_TRUE(is_held_reached(Transfer::Serial, "/dev/ttyS0@9600", line));
  EXPECT_FALSE(is_held_reached(Transfer::Serial, "/dev/ttyS1@9600", line));
  EXPECT_TRUE(is_held_reached(Transfer::Serial, "enable", named));
  EXPECT_TRUE(is_held_reached(Transfer::Serial, "/dev/pts/3", named)) << "a pseudo-terminal by its own name";
}

TEST(LinuxFlowAccess, OfTcpIsToItsPortAndReachesWhoeverListensThere) {
  const Sandbox open = open_for(Transfer::Tcp, "127.0.0.1:5000"), far = open_for(Transfer::Tcp, "192.0.2.7:5000");
  EXPECT_EQ(open.sockets, (SandboxSockets{.ports = {5000}}));
  EXPECT_EQ(far.sockets, (SandboxSockets{.datagrams = true, .ports = {5000}, .own_port = true}));
  EXPECT_TRUE(is_held_reached(Transfer::Tcp, "127.0.0.1:5000", far));
  EXPECT_FALSE(is_held_reached(Transfer::Tcp, "127.0.0.1:5001", far));
  EXPECT_FALSE(is_held_reached(Transfer::Tcp, "192.0.2.9:5000", far));
  Sandbox ground;
  ground.sockets.streams = true;
  EXPECT_TRUE(is_held_reached(Transfer::Tcp, "127.0.0.1:5001", ground));
  EXPECT_TRUE(is_held_reached(Transfer::Udp, "127.0.0.1:5001", far))
      << "it asks by a datagram from where it would speak";
}

TEST(LinuxFlowAccess, OfQueuesIsToAllOfThem) {
  const Sandbox open = open_for(Transfer::MessageQueue, "arm");
  EXPECT_TRUE(open.queues);
  EXPECT_THAT(open.writable, ElementsAre("/dev/mqueue"));
  EXPECT_TRUE(is_held_reached(Transfer::MessageQueue, "enable", open));
}

TEST(LinuxFlowAccess, OfAUserOfItsOwnIsToAFolderOrALineOfItsOwnAndToNoPseudoTerminalOrQueue) {
  Sandbox own;
  let_in({Transfer::SharedMemory, "arm"}, "twin", own, ProcessUser::ItsOwn);
  let_in({Transfer::Serial, "/dev/ttyS0@9600"}, "twin", own, ProcessUser::ItsOwn);
  let_in({Transfer::MessageQueue, "arm"}, "twin", own, ProcessUser::ItsOwn);
  EXPECT_THAT(own.writable, ElementsAre("/dev/shm/hirosco/arm.twin", "/dev/ttyS0"));
  EXPECT_FALSE(own.queues);
  EXPECT_EQ(why_not_own({Transfer::SharedMemory, "arm"}), "");
  EXPECT_EQ(why_not_own({Transfer::Tcp, "127.0.0.1:5000"}), "");
  EXPECT_EQ(why_not_own({Transfer::Serial, "/dev/ttyS0"}), "");
  EXPECT_EQ(why_not_own({Transfer::Serial, "arm"}), "a pseudo-terminal belongs to whoever plays the device");
  EXPECT_EQ(why_not_own({Transfer::MessageQueue, "arm"}), "by message_queue nothing is known of whose it is");
}

TEST(LinuxFlowAccess, OfAUserOfItsOwnToSharedMemoryIsMadeAtEachStartAndRemovedAtTheEnd) {
  const FlowAddress at{Transfer::SharedMemory, "own-access." + std::to_string(::getpid())};
  const OwnGroup group{.group = ::getegid()};
  for (const PlaceTime time : {PlaceTime::BeforeFlight, PlaceTime::AtStart}) {
    ASSERT_TRUE(make_own_place(at, "", group, time));
    EXPECT_TRUE(is_private_folder(own_folder(at, ""), group.group));
    remove_place(at, "", ProcessUser::ItsOwn);
    EXPECT_FALSE(std::filesystem::exists(own_folder(at, "")));
  }
}

}  // namespace
}  // namespace hirosco
