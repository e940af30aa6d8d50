// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/subsystem_sandbox.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/inotify.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/descriptor/read/brought_files.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/sanitizer.hpp"
#include "supervisor/platform/launch/memory_reach.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

descriptor::Endnode endnode_at(Transfer transfer, const std::string& address) {
  descriptor::Endnode made;
  made.transfer = transfer;
  made.address = address;
  return made;
}

descriptor::MissionSubsystem with_device(Transfer transfer, const char* address) {
  descriptor::MissionSubsystem made;
  made.subsystem.file = "/missions/arm.xml";
  made.subsystem.devices.resize(1);
  descriptor::Configuration configuration;
  descriptor::DeviceUse use;
  use.endnode = endnode_at(transfer, address);
  configuration.devices.push_back(use);
  made.subsystem.configurations.push_back(configuration);
  return made;
}

TEST(SubsystemSandbox, NamesItsProgramAndDescriptorsAndNothingToWriteButWhatItsDevicesNeed) {
  auto plain = with_device(Transfer::Udp, "127.0.0.1:5000");
  plain.subsystem.commands.resize(1);
  plain.subsystem.commands[0].file = "/missions/hand.xml";
  const Sandbox sandbox = sandbox_of(plain, "/opt/hirosco/bin/arm", {});
  EXPECT_THAT(sandbox.executable, Contains("/opt/hirosco/bin/arm"));
  EXPECT_THAT(sandbox.readable, Contains("/missions/arm.xml"));
  EXPECT_THAT(sandbox.readable, Contains("/missions/hand.xml"));
  EXPECT_THAT(sandbox.writable, ElementsAre("/dev/null"));
  EXPECT_THAT(sandbox.executable, Not(Contains("/usr/bin")));
}

TEST(SubsystemSandbox, OpensTheFolderThatADevicesTransferWritesTo) {
  EXPECT_THAT(sandbox_of(with_device(Transfer::SharedMemory, "arm"), "/bin/arm", {}).writable,
              ElementsAre("/dev/null", "/dev/shm/hirosco/arm"));
  EXPECT_THAT(sandbox_of(with_device(Transfer::Unix, "/run/arm/socket"), "/bin/arm", {}).writable,
              ElementsAre("/dev/null", "/run/arm"));
}

TEST(SubsystemSandbox, OpensTheFolderOfEachAddressOfItsOwnFlightAndNotTheOneThatAllAreIn) {
  auto arm = with_device(Transfer::SharedMemory, "arm");
  auto& uses = arm.subsystem.configurations[0].devices;
  uses[0].fall_backs = {endnode_at(Transfer::SharedMemory, "arm-b"), endnode_at(Transfer::Unix, "/run/arm/socket")};
  arm.subsystem.configurations.push_back(with_device(Transfer::SharedMemory, "hand").subsystem.configurations[0]);
  arm.subsystem.configurations.push_back(arm.subsystem.configurations[0]);
  EXPECT_THAT(sandbox_of(arm, "/bin/arm", "twin").writable,
              ElementsAre("/dev/null", "/dev/shm/hirosco/arm.twin", "/dev/shm/hirosco/arm-b.twin", "/run/arm",
                          "/dev/shm/hirosco/hand.twin"));
}

TEST(SubsystemSandbox, IsMadeWithTheFoldersOfItsFramesAndWithoutWhatOnlyHasTheNameOfOne) {
  const std::string address = "made." + std::to_string(::getpid());
  const std::string link = device_memory_folder(address + "-link");
  auto arm = with_device(Transfer::SharedMemory, address.c_str());
  for (const std::string& other : {address + "-b", address + "-link", std::string{".."}})
    arm.subsystem.configurations[0].devices[0].fall_backs.push_back(endnode_at(Transfer::SharedMemory, other));
  make_device_memory_folder(address).value();
  std::filesystem::create_symlink("/dev/shm", link);
  EXPECT_THAT(make_sandbox(arm, "/bin/arm", {}).writable,
              ElementsAre("/dev/null", device_memory_folder(address), device_memory_folder(address + "-b")));
  EXPECT_TRUE(std::filesystem::is_directory(device_memory_folder(address + "-b")));
  std::filesystem::remove(link);
  for (const char* which : {"", "-b"}) remove_device_memory_folder(address + which);
}

TEST(SubsystemSandbox, LetsMakeTheSocketsOfItsDevicesLinksAndGroundLinkAndNoOthers) {
  const auto sockets = [](Transfer transfer, const char* address) {
    return sandbox_of(with_device(transfer, address), "/bin/arm", {}).sockets;
  };
  EXPECT_EQ(sockets(Transfer::SharedMemory, "arm"), SandboxSockets{});
  EXPECT_EQ(sockets(Transfer::Serial, "/dev/ttyS0@115200"), SandboxSockets{});
  EXPECT_EQ(sockets(Transfer::Unix, "arm"), (SandboxSockets{.local = true}));
  EXPECT_EQ(sockets(Transfer::Udp, "127.0.0.1:5000"), (SandboxSockets{.datagrams = true}));
  EXPECT_EQ(sockets(Transfer::Tcp, "127.0.0.1:5000"), (SandboxSockets{.ports = {5000}}));
  EXPECT_EQ(sockets(Transfer::Tcp, "192.0.2.7:5000"),
            (SandboxSockets{.datagrams = true, .ports = {5000}, .own_port = true}))
      << "finds out by a datagram from where it would speak";
  auto linked = with_device(Transfer::SharedMemory, "arm");
  linked.link_methods = {LinkMethod::SharedMemory, LinkMethod::Udp};
  EXPECT_EQ(sandbox_of(linked, "/bin/arm", {}).sockets, (SandboxSockets{.datagrams = true}));
  auto ground = descriptor::MissionSubsystem{};
  ground.subsystem.file = "/missions/link.xml";
  ground.carries_ground = true;
  EXPECT_EQ(sandbox_of(ground, "/bin/link", {}).sockets, (SandboxSockets{.datagrams = true, .streams = true}));
}

TEST(SubsystemSandbox, SaysWhatItCannotNarrowDown) {
  const auto open = [](Transfer transfer, const char* address) {
    return left_open(sandbox_of(with_device(transfer, address), "/bin/arm", {}));
  };
  EXPECT_EQ(open(Transfer::SharedMemory, "arm"), "");
  EXPECT_EQ(open(Transfer::Tcp, "127.0.0.1:5000"), "");
  EXPECT_EQ(open(Transfer::Serial, "/dev/ttyS0@115200"), "");
  EXPECT_EQ(open(Transfer::Udp, "127.0.0.1:5000"), "all that listens by UDP");
  EXPECT_EQ(open(Transfer::Unix, "arm"), "all UNIX sockets that its user may open (a bus of his starts programs)");
  EXPECT_EQ(open(Transfer::MessageQueue, "arm"), "all message queues");
  EXPECT_EQ(open(Transfer::Serial, "arm@115200"), "all pseudo-terminals");
}

TEST(SubsystemSandbox, LetsReadWhatASettingOfADeviceNamesAsAFileAndNothingElseThatSettingsSay) {
  auto arm = with_device(Transfer::Udp, "127.0.0.1:5000");
  arm.subsystem.configurations[0].devices[0].settings = {
      {"MODEL_FILE", "../robots/arm.urdf", {}}, {"MODEL_NAME", "secret.txt", {}}, {"MAP_FILE", "/maps/all", {}}};
  const Sandbox sandbox = sandbox_of(arm, "/bin/arm", {});
  EXPECT_THAT(sandbox.readable, Contains("/robots/arm.urdf"));
  EXPECT_THAT(sandbox.readable, Contains("/maps/all"));
  EXPECT_THAT(sandbox.readable, Not(Contains("/missions/secret.txt")));
}

/// ARM with a file of a robot that names a mesh beside it, in a folder of its own, as a mission's reader leaves it.
struct RobotOnDisk {
  TestFolder folder;
  std::filesystem::path robot = folder.path() / "arm.urdf";
  descriptor::MissionSubsystem arm = with_device(Transfer::Udp, "127.0.0.1:5000");

  RobotOnDisk() {
    std::filesystem::create_directories(folder.path() / "parts");
    for (const char* name : {"parts/a.stl", "parts/b.stl", "notes"}) std::ofstream{folder.path() / name} << name;
    std::ofstream{robot} << "<robot><link><mesh filename='parts/a.stl'/><mesh filename='../b.stl'/></link></robot>";
    arm.subsystem.file = folder.path() / "arm.xml";
    arm.subsystem.configurations[0].devices[0].settings = {{"MODEL_FILE", "arm.urdf", {}}};
    arm.brought = descriptor::brought_files(arm.subsystem, descriptor::file_system());
  }
  [[nodiscard]] std::string place_of(const char* name) const { return (folder.path() / name).string(); }
};

TEST(SubsystemSandbox, LetsReadTheMeshesBesideARobotsFileThatItNames) {
  const RobotOnDisk disk;
  const Sandbox sandbox = sandbox_of(disk.arm, "/bin/arm", {});
  EXPECT_THAT(sandbox.readable, Contains(disk.place_of("arm.urdf")));
  EXPECT_THAT(sandbox.readable, Contains(disk.place_of("parts/a.stl")));
  EXPECT_THAT(sandbox.readable, Not(Contains(::testing::HasSubstr("b.stl"))));
}

TEST(SubsystemSandbox, IsMadeWithoutAFileBeingOpenedSoThatADiskThatStandsStillHoldsNobodyUp) {
  const RobotOnDisk disk;
  const FileDescriptor watch{::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)};
  ASSERT_GE(::inotify_add_watch(watch.get(), disk.folder.path().c_str(), IN_OPEN | IN_ACCESS), 0);
  std::array<char, 4096> events{};
  const auto opened = [&] { return ::read(watch.get(), events.data(), events.size()) > 0; };
  const Sandbox before = sandbox_of(disk.arm, "/bin/arm", {});
  EXPECT_FALSE(opened());
  static_cast<void>(std::ifstream{disk.robot}.get());
  EXPECT_TRUE(opened()) << "who opens one is seen";
  // A file that never answers who reads it.
  std::filesystem::remove(disk.robot);
  ASSERT_EQ(::mkfifo(disk.robot.c_str(), 0600), 0);
  EXPECT_EQ(sandbox_of(disk.arm, "/bin/arm", {}).readable, before.readable);
}

/// Apart (CMakeLists.txt), where the system has what a sandbox needs.
TEST(SubsystemInItsSandbox, ReadsTheRobotsFileAndItsMeshAndNothingElseInTheFolder) {
  for (const std::string& lack : isolation_lacks()) ASSERT_TRUE(lack.starts_with("every real-time priority")) << lack;
  const RobotOnDisk disk;
  const PreparedSandbox prepared{sandbox_of(disk.arm, {}, {})};
  const auto opens = [&](const char* name) {
    const FileDescriptor file{::open(disk.place_of(name).c_str(), O_RDONLY | O_CLOEXEC)};
    return static_cast<bool>(file);
  };
  const pid_t child = ::fork();
  if (child == 0) {
    if (prepared.enter() != 0) ::_exit(99);
    if (!opens("arm.urdf") || !opens("parts/a.stl")) ::_exit(1);
    if (opens("parts/b.stl") || opens("notes") || opens(".") || opens("parts")) ::_exit(2);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// Whether a subsystem in this sandbox hears what its device answers.
bool is_answered(const Sandbox& sandbox, const FlowAddress& at, int most_tries) {
  SystemFlowFactory flows{""};
  const PreparedSandbox prepared{sandbox};
  const auto device = flows.open(at, FlowSide::Device);
  if (!device) ADD_FAILURE() << to_text(at.transfer) << ": " << device.error().text << " " << device.error().value;
  if (!device) return false;
  std::array<std::byte, 8> buffer{};
  const auto has_come = [&](DataFlow& flow) {
    static_cast<void>(flow.wait(std::chrono::milliseconds{1}));
    const auto received = flow.receive(buffer);
    return received && received->flow == Flow::New;
  };
  const pid_t child = ::fork();
  if (child == 0) {
    if (prepared.enter() != 0) ::_exit(99);
    const auto own = flows.open(at, FlowSide::Subsystem);
    if (!own) ::_exit(1);
    for (int tries = 0; tries < most_tries; ++tries) {
      static_cast<void>((*own)->send(std::array{std::byte{7}}));
      if (has_come(**own)) ::_exit(0);
    }
    ::_exit(2);
  }
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0)
    if (has_come(**device)) static_cast<void>((*device)->send(std::array{std::byte{8}}));
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Of one process and computer, by the form of a means' addresses.
std::string own_address(AddressForm form) {
  if (form != AddressForm::HostPort) return "sandboxed-row." + std::to_string(::getpid());
  const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t octets = sizeof address;
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), octets), 0);
  EXPECT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &octets), 0);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

/// Apart (CMakeLists.txt), as above: what the row of each means says is what the system wants of it, a new one's, too.
TEST(SubsystemInItsSandbox, HearsItsDeviceByEachMeansOfTransferAsItsRowSaysAndByNoneWhereNothingIsSaid) {
  descriptor::MissionSubsystem bare;
  bare.subsystem.file = "/missions/bare.xml";
  for (const FlowMeans& means : standard_flow_means()) {
    const FlowAddress at{means.transfer, own_address(means.form)};
    const auto arm = with_device(means.transfer, at.address.c_str());
    const Sandbox let_in = make_sandbox(arm, {}, {});
    // What is not mounted here nobody is let into: /dev/mqueue of a container.
    const bool is_there =
        std::ranges::all_of(let_in.writable, [](const std::string& place) { return std::filesystem::exists(place); });
    EXPECT_EQ(is_answered(let_in, at, is_there ? 5000 : 100), is_there) << to_text(means.transfer);
    EXPECT_FALSE(is_answered(make_sandbox(bare, {}, {}), at, 100)) << to_text(means.transfer);
    remove_place(at, {});
  }
}

/// Apart (CMakeLists.txt), as above. The group is this process's: that of another is tried in a flight (tests/fault/own_users_test.py).
TEST(SubsystemInItsSandbox, HearsItsDeviceFromTheFolderThatIsItsOwnWhereItIsAUserOfItsOwn) {
  for (const FlowMeans& means : standard_flow_means()) {
    const FlowAddress at{means.transfer, own_address(means.form)};
    if (!why_not_own(at).empty()) continue;
    const auto arm = with_device(means.transfer, at.address.c_str());
    ASSERT_TRUE(make_own_place(at, {}, {.group = ::getegid()}, PlaceTime::BeforeFlight)) << to_text(means.transfer);
    EXPECT_TRUE(is_answered(sandbox_of(arm, {}, {}, ProcessUser::ItsOwn), at, 5000)) << to_text(means.transfer);
    remove_place(at, {}, ProcessUser::ItsOwn);
  }
}

/// Apart (CMakeLists.txt), as above.
TEST(SubsystemInItsSandbox, OpensTheFramesOfItsDeviceAndNoSecondInhibitNorThoseOfAnother) {
  const std::string address = "sandboxed." + std::to_string(::getpid());
  SystemFlowFactory flows{""};
  const FlowAddress frames{Transfer::SharedMemory, address}, others{Transfer::SharedMemory, address + "-other"};
  const FlowAddress held{
      .transfer = Transfer::SharedMemory, .address = address + "-enable", .holder = FlowHolder::Supervisor};
  const PreparedSandbox prepared{make_sandbox(with_device(Transfer::SharedMemory, address.c_str()), {}, {})};
  auto device = flows.open(frames, FlowSide::Device), guarded = flows.open(held, FlowSide::Device),
       another = flows.open(others, FlowSide::Device);
  ASSERT_TRUE(device);
  ASSERT_TRUE(guarded);
  ASSERT_TRUE(another);
  const pid_t child = ::fork();
  if (child == 0) {
    if (prepared.enter() != 0) ::_exit(99);
    auto own = flows.open(frames, FlowSide::Subsystem);
    if (!own || !(*own)->send(std::array{std::byte{7}})) ::_exit(1);
    const std::string here = device_memory_folder(address) + "/mine";
    for (const FlowAddress& not_its : {held, others}) {
      const std::string segment = device_memory_file(not_its.address, not_its.holder);
      for (const int how : {O_RDWR, O_RDONLY, O_WRONLY}) {
        const FileDescriptor file{::open(segment.c_str(), how | O_CLOEXEC)};
        if (file) ::_exit(2);
      }
      if (flows.open(not_its, FlowSide::Subsystem)) ::_exit(3);
      if (::rename(segment.c_str(), here.c_str()) == 0) ::_exit(4);
      if (::link(segment.c_str(), here.c_str()) == 0) ::_exit(5);
      if (::unlink(segment.c_str()) == 0) ::_exit(6);
    }
    if (flows.open({Transfer::SharedMemory, address + "-made"}, FlowSide::Subsystem)) ::_exit(7);
    if (::symlink("/dev/shm", (device_memory_folder(address) + "-link").c_str()) == 0) ::_exit(8);
    // That of the next process of its device, which a rule would not be about.
    if (::rename(device_memory_folder(address).c_str(), here.c_str()) == 0) ::_exit(9);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ((*device)->receive(buffer).value().octets, 1U);
  for (auto* flow : {&device, &another}) flow->value().reset();
  for (const FlowAddress& made : {frames, others}) remove_device_memory_folder(made.address);
}

/// What a hostile member tries on addresses of others, and on the folders that it has beside its own. 0: all refused.
int reached_of_others(const std::vector<std::string>& others, const std::string& here) {
  for (const std::string& place : others) {
    const std::string frames = place + "/frames", mine = here + "/mine";
    for (const int how : {O_RDWR, O_RDONLY, O_WRONLY | O_CREAT}) {
      const FileDescriptor file{::open(frames.c_str(), how | O_CLOEXEC, 0600)};
      if (file) return 11;
    }
    if (::rename(place.c_str(), mine.c_str()) == 0 || ::rename(here.c_str(), place.c_str()) == 0) return 12;
    if (::renameat2(AT_FDCWD, here.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0) return 13;
    if (::link(frames.c_str(), mine.c_str()) == 0 || ::symlink(place.c_str(), mine.c_str()) != 0) return 14;
    const FileDescriptor by_link{::open((mine + "/frames").c_str(), O_RDWR | O_CLOEXEC)};
    const FileDescriptor folder{::open(place.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)};
    const FileDescriptor below{::openat(folder.get(), "frames", O_RDWR | O_CLOEXEC)};
    ::unlink(mine.c_str());
    if (by_link || below) return 15;
  }
  return 0;
}

/// Whether the subsystem's end of that address, opened in this process, is heard by its device.
bool is_sent(const FlowAddress& at) {
  SystemFlowFactory flows{""};
  const auto own = flows.open(at, FlowSide::Subsystem);
  return own && (*own)->send(std::array{std::byte{7}});
}

/// Apart (CMakeLists.txt), as above. The process is one and the same from begin to end, and asks for the address of another and for the one
/// before as hostile ones would (docs/adr/0236).
TEST(SubsystemInItsSandbox, ComesToANewAddressAndLeavesTheOldOneInTheSameProcessAndToNoOtherWhateverItTries) {
  const std::string name = "sandboxed." + std::to_string(::getpid());
  const auto before = with_device(Transfer::SharedMemory, name.c_str()),
             after = with_device(Transfer::SharedMemory, (name + "-new").c_str());
  const FlowAddress old_one{Transfer::SharedMemory, name}, new_one{Transfer::SharedMemory, name + "-new"},
      of_another{Transfer::SharedMemory, name + "-other"};
  SystemFlowFactory flows{""};
  MemoryReach reach{""};
  Sandbox sandbox = make_sandbox(before, {}, {});
  SpareFolders spares = reach.make_spares(before, sandbox);
  const PreparedSandbox prepared{sandbox};
  std::vector<std::unique_ptr<DataFlow>> devices;
  for (const FlowAddress& at : {old_one, new_one, of_another})
    devices.push_back(flows.open(at, FlowSide::Device).value());
  const std::string own = device_memory_folder(old_one.address), fresh = device_memory_folder(new_one.address),
                    other = device_memory_folder(of_another.address);
  std::array<int, 2> there{}, back{};
  ASSERT_EQ(::pipe2(there.data(), O_CLOEXEC), 0);
  ASSERT_EQ(::pipe2(back.data(), O_CLOEXEC), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    if (prepared.enter() != 0) ::_exit(99);
    char turn = 0;
    // Before it is let in, then with both, then with the new one alone.
    if (!is_sent(old_one)) ::_exit(1);
    if (const int reached = reached_of_others({fresh, other}, own); reached != 0) ::_exit(reached);
    if (::write(there[1], "1", 1) != 1 || ::read(back[0], &turn, 1) != 1) ::_exit(2);
    if (!is_sent(new_one) || !is_sent(old_one)) ::_exit(3);
    if (::write(there[1], "2", 1) != 1 || ::read(back[0], &turn, 1) != 1) ::_exit(4);
    if (!is_sent(new_one)) ::_exit(5);
    if (is_sent(old_one)) ::_exit(6);
    if (const int reached = reached_of_others({own, other}, fresh); reached != 0) ::_exit(20 + reached);
    ::_exit(0);
  }
  reach.began(1, child, before, std::move(spares), true);
  // What it says ends with it.
  for (const int end : {there[1], back[0]}) ::close(end);
  char turn = 0;
  EXPECT_EQ(::read(there[0], &turn, 1), 1);
  EXPECT_EQ(reach.let_in(1, after, std::nullopt), "");
  EXPECT_EQ(::write(back[1], "1", 1), 1);
  EXPECT_EQ(::read(there[0], &turn, 1), 1);
  EXPECT_EQ(reach.keep_in(1, after), "");
  EXPECT_EQ(::write(back[1], "2", 1), 1);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  std::array<std::byte, 8> buffer{};
  for (std::size_t i = 0; i < devices.size(); ++i)
    EXPECT_EQ(devices[i]->receive(buffer).value_or(Received{}).octets, i < 2 ? 1U : 0U) << i;
  EXPECT_TRUE(is_sent(old_one)) << "whoever comes there next finds its device";
  reach.ended(1);
  EXPECT_THAT(SpareFolders::of(child).places(), ::testing::IsEmpty());
  devices.clear();
  for (const FlowAddress& made : {old_one, new_one, of_another}) remove_device_memory_folder(made.address);
}

TEST(SubsystemLimits, AreThoseOfItsDescriptor) {
  descriptor::Resources resources;
  EXPECT_FALSE(limits_of(resources).memory_octets);
  resources.most[static_cast<std::size_t>(descriptor::Resource::Memory)] = 8192;
  resources.most[static_cast<std::size_t>(descriptor::Resource::Descriptors)] = 40;
  EXPECT_EQ(limits_of(resources).descriptors, 40U);
  EXPECT_EQ(limits_of(resources).memory_octets,
            built_with_sanitizer || sandbox_is_off() ? std::optional<std::uint64_t>{} : std::uint64_t{8192} * 1024);
}

}  // namespace
}  // namespace hirosco::supervisor
