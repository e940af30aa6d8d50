// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/memory_reach.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"
#include "hirosco/utilities/os/sandbox.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
namespace fs = std::filesystem;

/// Process 1 flies by `arm`; the operating system's is the test's own. In a flight of a name of its own.
struct MemoryReachTest : ::testing::Test {
  const std::string instance = "test-" + std::to_string(::getpid());
  MemoryReach reach{instance};
  const descriptor::MissionSubsystem arm = at({"test-arm"}), moved = at({"test-arm-b"});

  ~MemoryReachTest() override {
    reach.ended(1);
    for (const char* address : {"test-arm", "test-arm-b", "test-hand"}) fs::remove_all(folder(address));
  }
  [[nodiscard]] static descriptor::MissionSubsystem at(std::initializer_list<const char*> addresses,
                                                       Transfer transfer = Transfer::SharedMemory) {
    descriptor::MissionSubsystem made;
    auto& configuration = made.subsystem.configurations.emplace_back();
    for (const char* address : addresses) {
      auto& endnode = configuration.devices.emplace_back().endnode;
      endnode.transfer = transfer;
      endnode.address = address;
    }
    return made;
  }
  [[nodiscard]] std::string folder(const char* address) const {
    return device_memory_folder(std::string{address} + "." + instance);
  }
  [[nodiscard]] static ino_t number_of(const std::string& file) {
    struct stat found{};
    return ::lstat(file.c_str(), &found) == 0 ? found.st_ino : 0;
  }
  void start(const descriptor::MissionSubsystem& subsystem, bool in_sandbox = true) {
    Sandbox sandbox;
    SpareFolders spares = in_sandbox ? reach.make_spares(subsystem, sandbox) : SpareFolders{};
    EXPECT_EQ(sandbox.writable.size(), spares.places().size());
    reach.began(1, ::getpid(), subsystem, std::move(spares), in_sandbox);
  }
  [[nodiscard]] std::vector<std::string> possible(const descriptor::MissionSubsystem& fresh) const {
    Sandbox had;
    reach.add_possible(1, fresh, had);
    return had.writable;
  }
};

TEST_F(MemoryReachTest, OfAProcessHasASpareFolderForEachAddressThatMayBecomeAnother) {
  Sandbox sandbox;
  EXPECT_THAT(reach.make_spares(at({"test-arm", "test-hand", "test-arm"}), sandbox).places(), SizeIs(2));
  EXPECT_THAT(reach.make_spares(at({"127.0.0.1:5000"}, Transfer::Udp), sandbox).places(), SizeIs(1));
  EXPECT_THAT(reach.make_spares({}, sandbox).places(), IsEmpty());
}

TEST_F(MemoryReachTest, GoesToTheNewAddressAndFromTheOldOne) {
  make_device_memory_folder("test-arm." + instance).value();
  start(arm);
  const ino_t spare = number_of(SpareFolders::of(::getpid()).places().at(0)), own = number_of(folder("test-arm"));
  EXPECT_THAT(possible(moved), Contains(folder("test-arm-b")));
  EXPECT_EQ(reach.let_in(1, moved, std::nullopt), "");
  EXPECT_EQ(number_of(folder("test-arm-b")), spare) << "into which it was let when it started";
  EXPECT_EQ(number_of(folder("test-arm")), own) << "nobody has taken anything yet";
  EXPECT_EQ(reach.keep_in(1, moved), "");
  EXPECT_TRUE(fs::is_directory(folder("test-arm")));
  EXPECT_NE(number_of(folder("test-arm")), own) << "the one that it was let in to is there no more";
  // What it has let go of is what it goes to the next time.
  EXPECT_EQ(reach.let_in(1, arm, std::nullopt), "");
  EXPECT_EQ(reach.keep_in(1, arm), "");
  EXPECT_EQ(number_of(folder("test-arm")), own);
}

TEST_F(MemoryReachTest, StaysAsItWasWhereTheNewTextIsNotTaken) {
  start(arm);
  EXPECT_EQ(reach.let_in(1, moved, std::nullopt), "");
  const ino_t given = number_of(folder("test-arm-b"));
  EXPECT_EQ(reach.keep_in(1, arm), "");
  EXPECT_NE(number_of(folder("test-arm-b")), given);
  EXPECT_THAT(SpareFolders::of(::getpid()).places(), SizeIs(1));
}

TEST_F(MemoryReachTest, HasNoMoreThanItsFoldersAndNoneOfWhomNothingIsKnown) {
  start(arm);
  EXPECT_THAT(possible(at({"test-arm", "test-arm-b"})), SizeIs(1));
  EXPECT_THAT(possible(at({"test-arm-b", "test-hand"})), SizeIs(1)) << "two of them, and one spare folder";
  EXPECT_THAT(reach.let_in(1, at({"test-arm-b", "test-hand"}), std::nullopt), HasSubstr("none of the folders"));
  Sandbox had;
  reach.add_possible(2, moved, had);
  EXPECT_THAT(had.writable, IsEmpty());
}

TEST_F(MemoryReachTest, IsNotWhatAnotherSubsystemWasLetInto) {
  start(arm);
  reach.began(2, ::getpid(), at({"test-hand"}), {}, true);
  EXPECT_EQ(reach.let_in(1, at({"test-hand"}), std::nullopt),
            folder("test-hand") + ": another subsystem was let in there");
  EXPECT_FALSE(fs::exists(folder("test-hand")));
  reach.ended(2);
  EXPECT_EQ(reach.let_in(1, at({"test-hand"}), std::nullopt), "");
}

TEST_F(MemoryReachTest, IsToldWithTheFolderThatIsNoneAndWhy) {
  start(arm);
  std::ofstream{folder("test-arm-b")} << "a file";
  EXPECT_EQ(reach.let_in(1, moved, std::nullopt),
            folder("test-arm-b") + ": a file or link stands where the folder of its frames in shared memory is to be");
  fs::remove(folder("test-arm-b"));
}

TEST_F(MemoryReachTest, OfAUserOfItsOwnIsShutToAllOthersAtTheNewAddress) {
  start(arm);
  const OwnGroup own{.group = ::getegid(), .of_flight = {}};
  ASSERT_EQ(reach.let_in(1, moved, own), "");
  EXPECT_TRUE(is_private_folder(folder("test-arm-b"), ::getegid()));
}

TEST_F(MemoryReachTest, WithoutASandboxIsWhateverIsThere) {
  start(arm, false);
  EXPECT_THAT(possible(at({"test-arm-b", "test-hand"})), SizeIs(2));
  EXPECT_EQ(reach.let_in(1, moved, std::nullopt), "");
  EXPECT_TRUE(fs::is_directory(folder("test-arm-b")));
  EXPECT_EQ(reach.keep_in(1, moved), "");
}

TEST_F(MemoryReachTest, GoesOnWhereAnotherSupervisorDoes) {
  if (sandbox_is_off()) return;  // nothing has to be found again
  start(arm);
  const ino_t spare = number_of(SpareFolders::of(::getpid()).places().at(0));
  MemoryReach next{instance};
  next.goes_on(7, ::getpid(), arm);
  EXPECT_EQ(next.let_in(7, moved, std::nullopt), "");
  EXPECT_EQ(number_of(folder("test-arm-b")), spare);
  next.ended(7);
}

}  // namespace
}  // namespace hirosco::supervisor
