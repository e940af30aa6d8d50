// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <mqueue.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <barrier>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"
#include "hirosco/data_transfer/device/private_memory_folder.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/data_transfer/device/testing/flow_conformance.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco::testing {
namespace {

/// Tests of several checkouts may run side by side. The folders of flights stay, those of tests do not.
class UniqueNames {
 public:
  ~UniqueNames() {
    for (int number = 0; number < next_; ++number)
      for (const char* instance : {"", "one", "two", "twin"})
        remove_device_memory_folder(name(number) + instance_suffix(instance));
  }
  std::string next() { return name(next_++); }

 private:
  [[nodiscard]] static std::string name(int number) {
    return "test-" + std::to_string(::getpid()) + "-" + std::to_string(number);
  }
  std::atomic<int> next_{0};
};

std::string unique_name() {
  static UniqueNames names;
  return names.next();
}

/// A port that the system says is free.
std::string free_port(int kind = SOCK_DGRAM) {
  const FileDescriptor socket{::socket(AF_INET, kind | SOCK_CLOEXEC, 0)};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t octets = sizeof address;
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), octets), 0);
  EXPECT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &octets), 0);
  return std::to_string(ntohs(address.sin_port));
}

struct SharedMemoryTraits {
  using Factory = SystemFlowFactory;
  static constexpr bool knows_its_peer = true;
  static FlowAddress address() { return {Transfer::SharedMemory, unique_name()}; }
};
struct UnixTraits {
  using Factory = SystemFlowFactory;
  static constexpr bool knows_its_peer = false;
  static FlowAddress address() { return {Transfer::Unix, "/tmp/hirosco-" + unique_name()}; }
};
struct UdpTraits {
  using Factory = SystemFlowFactory;
  static constexpr bool knows_its_peer = false;
  static FlowAddress address() { return {Transfer::Udp, "127.0.0.1:" + free_port()}; }
};

struct TcpTraits {
  using Factory = SystemFlowFactory;
  static constexpr bool knows_its_peer = true;
  static FlowAddress address() { return {Transfer::Tcp, "127.0.0.1:" + free_port(SOCK_STREAM)}; }
};
struct SerialTraits {
  using Factory = SystemFlowFactory;
  static constexpr bool knows_its_peer = true;
  static constexpr bool hands_on_in_pieces = true;
  static FlowAddress address() { return {Transfer::Serial, "/tmp/hirosco-" + unique_name()}; }
};
struct MessageQueueTraits {
  using Factory = SystemFlowFactory;
  static constexpr bool knows_its_peer = true;
  static FlowAddress address() { return {Transfer::MessageQueue, unique_name()}; }
};

INSTANTIATE_TYPED_TEST_SUITE_P(SharedMemory, FlowConformance, SharedMemoryTraits);
INSTANTIATE_TYPED_TEST_SUITE_P(Unix, FlowConformance, UnixTraits);
INSTANTIATE_TYPED_TEST_SUITE_P(Udp, FlowConformance, UdpTraits);
INSTANTIATE_TYPED_TEST_SUITE_P(Tcp, FlowConformance, TcpTraits);
INSTANTIATE_TYPED_TEST_SUITE_P(Serial, FlowConformance, SerialTraits);
INSTANTIATE_TYPED_TEST_SUITE_P(MessageQueue, FlowConformance, MessageQueueTraits);

TEST(SystemFlowFactory, RefusesMeansThatAreNotBuiltIn) {
  SystemFlowFactory factory;
  for (const Transfer means : {Transfer::Ethercat, static_cast<Transfer>(99)})
    EXPECT_EQ(factory.open({means, "x"}, FlowSide::Subsystem).error().code, ErrorCode::NotPermitted);
}

TEST(SystemFlowFactory, KeepsTheDevicesOfTwoFlightsOfOneMissionApart) {
  SystemFlowFactory plain{""};
  SystemFlowFactory one{"one"};
  SystemFlowFactory two{"two"};
  for (const FlowAddress& address :
       {SharedMemoryTraits::address(), UnixTraits::address(), MessageQueueTraits::address()}) {
    const auto of_plain = plain.open(address, FlowSide::Device);
    const auto of_one = one.open(address, FlowSide::Device);
    ASSERT_TRUE(of_plain);
    ASSERT_TRUE(of_one) << "the same side of the same address, in another flight";
    const auto subsystem = two.open(address, FlowSide::Subsystem);
    const std::array<std::byte, 4> frame{};
    if (subsystem) {
      EXPECT_FALSE((*subsystem)->send(frame)) << "nobody listens in that flight";
    }
    EXPECT_TRUE(one.open(address, FlowSide::Subsystem).value()->send(frame));
    std::array<std::byte, 64> buffer;
    EXPECT_EQ((*of_plain)->receive(buffer).value().octets, 0U) << "it was for the other flight";
    EXPECT_EQ((*of_one)->receive(buffer).value().octets, frame.size());
  }
}

TEST(UdpFlow, RefusesEveryAddressOutsideThisComputer) {
  SystemFlowFactory factory;
  for (const Transfer means : {Transfer::Udp, Transfer::Tcp})
    for (const FlowSide side : {FlowSide::Device, FlowSide::Subsystem}) {
      for (const char* address : {"192.0.2.1:5000", "128.0.0.1:5000", "[2001:db8::7]:5000"})
        EXPECT_EQ(factory.open({means, address}, side).error().code, ErrorCode::NotPermitted) << address;
      for (const char* address : {"127.0.0.1", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:12x", "somewhere:5000", "",
                                  "0.0.0.0:5000", "224.0.0.1:5000"})
        EXPECT_EQ(factory.open({means, address}, side).error().code, ErrorCode::InvalidArgument) << address;
    }
}

TEST(DeviceNetworks, ALetInNetworkIsNoneWhereThisComputerHasNoAddressInIt) {
  SystemFlowFactory factory{"", read_device_networks("198.51.100.0/24 2001:db8::/32")};
  for (const Transfer means : {Transfer::Udp, Transfer::Tcp}) {
    EXPECT_EQ(factory.open({means, "198.51.100.1:5000"}, FlowSide::Subsystem).error().code, ErrorCode::Unavailable);
    EXPECT_EQ(factory.open({means, "203.0.113.1:5000"}, FlowSide::Subsystem).error().code, ErrorCode::NotPermitted);
  }
}

TEST(UnixFlow, TakesOverThePathOfADeadProcessButNoFile) {
  SystemFlowFactory factory;
  const FlowAddress address = UnixTraits::address();
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const auto opened = factory.open(address, FlowSide::Device);
    ::_exit(opened ? 0 : 1);  // leaves the path behind
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(std::filesystem::exists(address.address));
  EXPECT_TRUE(factory.open(address, FlowSide::Device));

  const std::string file = address.address + ".file";
  std::ofstream{file} << "kept";
  EXPECT_EQ(factory.open({Transfer::Unix, file}, FlowSide::Device).error().code, ErrorCode::AlreadyExists);
  EXPECT_TRUE(std::filesystem::remove(file));
}

TEST(SharedMemoryFlow, UsesTheSegmentOfAKilledProcessAgain) {
  SystemFlowFactory factory;
  const FlowAddress address = SharedMemoryTraits::address();
  auto subsystem = factory.open(address, FlowSide::Subsystem).value();
  for (int life = 0; life < 3; ++life) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      auto device = factory.open(address, FlowSide::Device);
      if (!device) ::_exit(1);
      std::array<std::byte, max_frame_octets> frame{};
      for (;;) (void)(*device)->send(frame);  // killed most likely in the middle of a frame
    }
    EXPECT_TRUE(subsystem->wait(std::chrono::seconds{60}));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  }
  auto device = factory.open(address, FlowSide::Device);
  ASSERT_TRUE(device) << device.error().text;
  std::array<std::byte, max_frame_octets> buffer{};
  (void)subsystem->receive(buffer);
  ASSERT_TRUE((*device)->send(std::array{std::byte{1}, std::byte{2}}));
  const auto received = subsystem->receive(buffer).value();
  EXPECT_EQ(received.flow, Flow::New);
  EXPECT_EQ(received.octets, 2u);
}

TEST(SharedMemoryFlow, LeavesNoNameBehindWhenBothSidesHaveClosed) {
  SystemFlowFactory factory;
  const FlowAddress address = SharedMemoryTraits::address();
  auto subsystem = factory.open(address, FlowSide::Subsystem).value();
  auto device = factory.open(address, FlowSide::Device).value();
  subsystem.reset();
  const std::filesystem::path folder = "/dev/shm/hirosco/" + address.address;
  EXPECT_TRUE(std::filesystem::exists(folder / "frames"));
  device.reset();
  EXPECT_FALSE(std::filesystem::exists(folder / "frames"));
  EXPECT_TRUE(std::filesystem::exists(folder)) << "whoever is let in there would not be in another";
}

TEST(SharedMemoryFlow, HasAFolderForEachAddressWhoeverComesFirst) {
  namespace fs = std::filesystem;
  SystemFlowFactory factory;
  for (const FlowSide side : {FlowSide::Subsystem, FlowSide::Device}) {
    const FlowAddress address = SharedMemoryTraits::address();
    const auto first = factory.open({address.transfer, "a/" + address.address}, side);
    ASSERT_TRUE(first);
    const fs::path folder = "/dev/shm/hirosco/a." + address.address;
    EXPECT_EQ(fs::status(folder).permissions(), fs::perms::all | fs::perms::sticky_bit) << "whatever the mask";
    remove_device_memory_folder("a." + address.address);
    EXPECT_TRUE(fs::exists(folder / "frames")) << "in use";
    fs::remove_all(folder);
    EXPECT_TRUE(factory.open({address.transfer, "a." + address.address}, side))
        << "one that was taken away is made again";
    remove_device_memory_folder("a." + address.address);
    EXPECT_FALSE(fs::exists(folder));
  }
}

TEST(SharedMemoryFlow, OfAUserOfItsOwnIsOpenToBothInAFolderThatIsShutToAllOthers) {
  namespace fs = std::filesystem;
  SystemFlowFactory factory{""};
  const FlowAddress address = SharedMemoryTraits::address();
  const std::string folder = device_memory_folder(address.address);
  const auto rights = [](const std::string& place) { return static_cast<int>(fs::status(place).permissions()); };
  auto before = factory.open(address, FlowSide::Device);
  ASSERT_TRUE(before);
  EXPECT_EQ(rights(folder + "/frames"), 0600);
  EXPECT_EQ(make_private_memory_folder(address.address, ::getegid()).error().code, ErrorCode::Mismatch)
      << "who has them open would go on with frames that the other may not open";
  EXPECT_NE(rights(folder), 0770) << "and is found again";
  before->reset();
  fs::remove_all(folder);
  make_device_memory_folder(address.address).value();
  std::ofstream{folder + "/frames"} << "left by somebody who died";
  ASSERT_TRUE(make_private_memory_folder(address.address, ::getegid()));
  EXPECT_EQ(rights(folder), 0770);
  EXPECT_FALSE(fs::exists(folder + "/frames")) << "whoever had made them";
  auto device = factory.open(address, FlowSide::Device);
  auto subsystem = factory.open(address, FlowSide::Subsystem);
  ASSERT_TRUE(device && subsystem);
  EXPECT_EQ(rights(folder + "/frames"), 0666);
  EXPECT_TRUE(make_private_memory_folder(address.address, ::getegid())) << "at each start: frames of now stay";
  EXPECT_TRUE(fs::exists(folder + "/frames"));
  device->reset();
  subsystem->reset();
  remove_device_memory_folder(address.address);
}

TEST(UnixFlow, OfAUserOfItsOwnHasSocketsThatBothMaySendToInAFolderThatIsShut) {
  namespace fs = std::filesystem;
  std::string root = (fs::temp_directory_path() / "hirosco-sockets-XXXXXX").string();
  ASSERT_NE(::mkdtemp(root.data()), nullptr);
  ASSERT_TRUE(make_private_folder(root + "/arm", ::getegid(), {}));
  SystemFlowFactory factory{""};
  {
    const auto device = factory.open({Transfer::Unix, root + "/arm"}, FlowSide::Device);
    const auto subsystem = factory.open({Transfer::Unix, root + "/arm"}, FlowSide::Subsystem);
    ASSERT_TRUE(device && subsystem);
    for (const char* end : {"/arm/socket", "/arm/socket.subsystem"})
      EXPECT_EQ(static_cast<int>(fs::status(root + end).permissions()), 0777) << end;
    ASSERT_TRUE((*device)->send(std::array{std::byte{7}}));
    std::array<std::byte, 8> buffer{};
    EXPECT_EQ((*subsystem)->receive(buffer)->octets, 1U);
  }
  EXPECT_TRUE(fs::is_empty(root + "/arm"));
  fs::remove_all(root);
}

TEST(SharedMemoryFlow, IsOpenedInNoFolderThatALinkOrAnAddressLeadsTo) {
  SystemFlowFactory factory{""};
  const FlowAddress address = SharedMemoryTraits::address();
  make_device_memory_folder(address.address).value();
  const std::filesystem::path folder = device_memory_folder(address.address), link = folder.string() + "-link";
  std::filesystem::create_symlink(folder, link);
  EXPECT_EQ(factory.open({address.transfer, link.filename()}, FlowSide::Device).error().code, ErrorCode::Mismatch);
  remove_device_memory_folder(link.filename());
  EXPECT_TRUE(std::filesystem::is_symlink(link)) << "it is nobody's folder";
  std::filesystem::remove(link);
  for (const char* way_out : {".", "..", "/", "./", "//"})
    EXPECT_EQ(factory.open({address.transfer, way_out}, FlowSide::Device).error().code, ErrorCode::InvalidArgument)
        << way_out;
}

/// Closes both sides at the same time, so often that they meet. `remove` takes away what they left and says how much that was; returns the sum.
int left_by_two_that_close_at_once(const FlowAddress& address, const std::function<int()>& remove) {
  int left = 0;
  for (int i = 0; i < 2000; ++i) {
    SystemFlowFactory factory;
    auto subsystem = factory.open(address, FlowSide::Subsystem).value();
    auto device = factory.open(address, FlowSide::Device).value();
    std::barrier both{2};
    std::thread closing{[&] {
      both.arrive_and_wait();
      device.reset();
    }};
    both.arrive_and_wait();
    subsystem.reset();
    closing.join();
    left += remove();
  }
  return left;
}

TEST(SharedMemoryFlow, LeavesNoNameBehindWhenBothSidesCloseAtOnce) {
  const FlowAddress address = SharedMemoryTraits::address();
  const std::string file = "/dev/shm/hirosco/" + address.address + "/frames";
  EXPECT_EQ(left_by_two_that_close_at_once(address, [&] { return std::filesystem::remove(file) ? 1 : 0; }), 0);
}

TEST(MessageQueueFlow, LeavesNoNameBehindWhenBothSidesCloseAtOnce) {
  const FlowAddress address = MessageQueueTraits::address();
  const std::string queue = "/hirosco." + address.address;
  const auto remove = [&] {
    int left = 0;
    for (const char* way : {".to_device", ".to_subsystem"}) left += ::mq_unlink((queue + way).c_str()) == 0 ? 1 : 0;
    return left;
  };
  EXPECT_EQ(left_by_two_that_close_at_once(address, remove), 0);
}

TEST(SharedMemoryFlow, OfTheSupervisorsSideIsNotWhereThoseOfSubsystemsAre) {
  SystemFlowFactory factory{"twin"};
  FlowAddress address = SharedMemoryTraits::address();
  auto frames = factory.open(address, FlowSide::Subsystem).value();
  address.holder = FlowHolder::Supervisor;
  auto held = factory.open(address, FlowSide::Subsystem);
  ASSERT_TRUE(held) << "not the same though it has the same address";
  EXPECT_TRUE(std::filesystem::exists("/dev/shm/hirosco/" + address.address + ".twin/frames"));
  EXPECT_TRUE(std::filesystem::exists("/dev/shm/hirosco." + address.address + ".twin"));
  auto device = factory.open(address, FlowSide::Device).value();
  ASSERT_TRUE((*held)->send(std::array{std::byte{1}}));
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(device->receive(buffer).value().octets, 1U);
  held->reset();
  device.reset();
  EXPECT_FALSE(std::filesystem::exists("/dev/shm/hirosco." + address.address + ".twin"));
}

TEST(SharedMemoryFlow, NeitherSideHasGoneBeforeItCame) {
  SystemFlowFactory factory;
  const FlowAddress address = SharedMemoryTraits::address();
  auto subsystem = factory.open(address, FlowSide::Subsystem).value();
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(subsystem->receive(buffer).value().flow, Flow::None);
  EXPECT_EQ(subsystem->send(buffer).error().code, ErrorCode::Unavailable);
}

TEST(SharedMemoryFlow, WakesAWaitingSideForAFrameAndForTheEnd) {
  SystemFlowFactory factory;
  const FlowAddress address = SharedMemoryTraits::address();
  auto device = factory.open(address, FlowSide::Device).value();
  auto subsystem = factory.open(address, FlowSide::Subsystem).value();
  int frames = 0;
  bool ended = false;
  std::thread waiting{[&] {
    std::array<std::byte, max_frame_octets> buffer{};
    while (!ended) {
      if (!device->wait(std::chrono::hours{1})) break;
      const auto received = device->receive(buffer);
      ended = !received;
      if (received && received->flow == Flow::New) {
        ++frames;
        (void)device->send(Octets{buffer}.first(received->octets));
      }
    }
  }};
  std::array<std::byte, max_frame_octets> buffer{};
  for (std::size_t octets = 1; octets <= 200; ++octets) {
    ASSERT_TRUE(subsystem->send(Octets{buffer}.first(octets)));
    ASSERT_TRUE(subsystem->wait(std::chrono::hours{1}));
    EXPECT_EQ(subsystem->receive(buffer).value().octets, octets);
  }
  subsystem.reset();
  waiting.join();
  EXPECT_EQ(frames, 200);
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace hirosco::testing
