// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/spare_folders.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
namespace fs = std::filesystem;

/// A process that rests, whose folders these are, and an address that is not its own.
struct SpareFoldersTest : ::testing::Test {
  const std::string address = "test-given." + std::to_string(::getpid()), place = device_memory_folder(address);
  SystemFlowFactory flows{""};
  pid_t pid{0};

  void SetUp() override {
    pid = ::fork();
    if (pid == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      for (;;) ::pause();
    }
    make_device_memory_folder(address).value();
  }
  void TearDown() override {
    end();
    SpareFolders::of(pid).remove();
    fs::remove_all(place);
  }
  void end() {
    if (::kill(pid, SIGKILL) == 0) ::waitpid(pid, nullptr, 0);
  }
  [[nodiscard]] std::string named(int number) const {
    return "/dev/shm/hirosco-spare." + std::to_string(pid) + "." + std::to_string(number);
  }
  [[nodiscard]] SpareFolders of_process(std::size_t wanted) const {
    SpareFolders spares = SpareFolders::make(wanted);
    spares.belong_to(pid);
    return spares;
  }
  [[nodiscard]] static ino_t number_of(const std::string& file) {
    struct stat found{};
    return ::lstat(file.c_str(), &found) == 0 ? found.st_ino : 0;
  }
};

TEST_F(SpareFoldersTest, AreThoseOfTheProcessOnceItRunsAndAreFoundByItsNumber) {
  SpareFolders spares = SpareFolders::make(2);
  ASSERT_THAT(spares.places(), SizeIs(2));
  const ino_t first = number_of(spares.places()[0]);
  EXPECT_EQ(fs::status(spares.places()[0]).permissions(), fs::perms::owner_all);
  // By which a process finds them that comes to them only when they have its name.
  struct stat for_sandbox{};
  ASSERT_THAT(spares.for_sandbox(), SizeIs(2));
  ASSERT_EQ(::stat(spares.for_sandbox()[0].c_str(), &for_sandbox), 0);
  EXPECT_EQ(for_sandbox.st_ino, first);
  spares.belong_to(pid);
  EXPECT_THAT(spares.for_sandbox(), IsEmpty());
  EXPECT_THAT(spares.places(), ElementsAre(named(0), named(1)));
  EXPECT_EQ(number_of(named(0)), first) << "the folder that it was let in to";
  EXPECT_THAT(SpareFolders::of(pid).places(), ::testing::UnorderedElementsAre(named(0), named(1)));
  EXPECT_THAT(SpareFolders::of(::getpid()).places(), IsEmpty());
  spares.remove();
  EXPECT_THAT(SpareFolders::of(pid).places(), IsEmpty());
}

TEST_F(SpareFoldersTest, GoWhereNoProcessHasComeToThemAndStayWhereOneHas) {
  std::string place_of_none;
  {
    const SpareFolders spares = SpareFolders::make(1);
    place_of_none = spares.places().at(0);
    EXPECT_TRUE(fs::is_directory(place_of_none));
    static_cast<void>(of_process(1));
  }
  EXPECT_FALSE(fs::exists(place_of_none));
  EXPECT_TRUE(fs::is_directory(named(0))) << "the next supervisor finds it";
}

TEST_F(SpareFoldersTest, GiveOneToAnAddressAndTakeItBackWhileItsDeviceGoesOn) {
  SpareFolders spares = of_process(1);
  const ino_t spare = number_of(named(0));
  const auto device = flows.open({Transfer::SharedMemory, address}, FlowSide::Device).value();
  ASSERT_TRUE(spares.give(place));
  EXPECT_EQ(number_of(place), spare);
  EXPECT_THAT(spares.places(), IsEmpty());
  EXPECT_FALSE(fs::exists(named(0)));
  EXPECT_EQ(spares.give(place).error().code, ErrorCode::NotFound) << "none is left";
  ASSERT_TRUE(spares.take_back(place));
  EXPECT_THAT(spares.places(), ElementsAre(named(0)));
  EXPECT_EQ(number_of(named(0)), spare);
  EXPECT_EQ(fs::status(named(0)).permissions(), fs::perms::owner_all);
  EXPECT_NE(number_of(place), spare);
  EXPECT_EQ(fs::status(place).permissions(), fs::perms::all | fs::perms::sticky_bit) << "of all, as before";
  const auto subsystem = flows.open({Transfer::SharedMemory, address}, FlowSide::Subsystem).value();
  EXPECT_TRUE(subsystem->send(std::array{std::byte{7}})) << "it listens";
  EXPECT_TRUE(spares.give(place + "-none").error().code == ErrorCode::Mismatch);
  EXPECT_TRUE(spares.take_back(place + "-none")) << "what is not there is nobody's";
  EXPECT_THAT(spares.places(), ElementsAre(named(0)));
}

TEST_F(SpareFoldersTest, GiveNoneWhereAnotherSubsystemIsOrSomethingElseThanFrames) {
  SpareFolders spares = of_process(1);
  const ino_t before = number_of(place);
  {
    const auto other = flows.open({Transfer::SharedMemory, address}, FlowSide::Subsystem).value();
    EXPECT_EQ(spares.give(place).error().code, ErrorCode::AlreadyExists);
  }
  std::ofstream{place + "/notes"} << "of somebody";
  EXPECT_EQ(spares.give(place).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(number_of(place), before);
  EXPECT_TRUE(fs::exists(place + "/notes"));
  EXPECT_THAT(spares.places(), SizeIs(1));
}

TEST_F(SpareFoldersTest, LeaveOutOneIntoWhichItsProcessHasPutSomething) {
  SpareFolders spares = of_process(2);
  const ino_t second = number_of(named(1));
  std::ofstream{named(0) + "/mine"} << "mine";
  ASSERT_TRUE(spares.give(place));
  EXPECT_EQ(number_of(place), second);
  EXPECT_THAT(spares.places(), ElementsAre(named(0)));
  fs::remove(named(0) + "/mine");
}

TEST_F(SpareFoldersTest, AreSweptAwayWhereTheirProcessIsGone) {
  static_cast<void>(of_process(1));
  SpareFolders::sweep();
  EXPECT_TRUE(fs::exists(named(0)));
  end();
  SpareFolders::sweep();
  EXPECT_FALSE(fs::exists(named(0)));
}

}  // namespace
}  // namespace hirosco::supervisor
