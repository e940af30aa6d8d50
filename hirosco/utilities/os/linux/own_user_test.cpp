// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/own_user.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "hirosco/utilities/os/linux/rights.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// Beyond those that a Debian gives to anybody.
constexpr std::uint32_t one_user = 60'600, other_user = 60'601, last_user = 60'699;

/// In a thread, whose rights are its own.
void without_rights(auto&& with) {
  auto thread = Thread::start("without rights", [&] {
    __user_cap_header_struct about{_LINUX_CAPABILITY_VERSION_3, 0};
    const std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> none{};
    ASSERT_EQ(::syscall(SYS_capset, &about, none.data()), 0);
    with();
  });
  ASSERT_TRUE(thread);
  thread->join();
}

TEST(RightsOverUsers, AreNamedWhereTheyAreLackingOneByOne) {
  without_rights([] {
    const auto lacking = lacking_for_own_users(one_user, last_user);
    for (const char* right : {"CAP_SETUID", "CAP_SETGID", "CAP_KILL", "CAP_SYS_NICE", "CAP_CHOWN"})
      EXPECT_THAT(lacking, Contains(right)) << "who cannot end another user starts none";
  });
}

TEST(RightsOverUsers, AreLackingToNumbersThatNoNameSpaceHas) {
  constexpr std::uint32_t none = 4'294'967'295U;  // of which no name space has a user
  EXPECT_THAT(lacking_for_own_users(none, none), Contains(HasSubstr("name space")));
}

TEST(RightsOverUsers, AProcessThatHasANumberIsFoundByItsProgram) {
  EXPECT_EQ(process_of_users(2'000'000'000U, 2'000'000'001U), "");
  EXPECT_THAT(process_of_users(::getuid(), ::getuid()), HasSubstr(" (")) << "this one at least";
}

/// Needs the rights: testing/with_own_users.
struct OwnUserTest : testing::Test {
  void SetUp() override { ASSERT_TRUE(lacking_for_own_users(one_user, last_user).empty()); }
  static ProcessStart as(std::uint32_t user, std::string command) {
    ProcessStart start;
    start.executable = "/bin/sh";
    start.arguments = {"-c", std::move(command)};
    start.user = user;
    return start;
  }
  static int code_of(Process& process) {
    WaitSet set;
    EXPECT_TRUE(set.add(process.handle().get()));
    EXPECT_EQ(set.wait(std::nullopt)->size(), 1U);
    return process.poll()->value().value;
  }
  static int code_of(const ProcessStart& start) {
    auto process = Process::spawn(start);
    EXPECT_TRUE(process) << process.error().text << " " << process.error().value;
    return process ? code_of(*process) : -1;
  }
};

TEST_F(OwnUserTest, AProcessIsThatUserInNoOtherGroupWithoutOurRights) {
  EXPECT_EQ(code_of(as(one_user,
                       "test \"$(id -u) $(id -ru) $(id -g) $(id -rg) $(id -G)\" = \"60600 60600 60600 60600 60600\"")),
            0);
  // Bits 0 to 7, 21, 24: owners, signals, users, the system, limits.
  EXPECT_EQ(code_of(as(one_user,
                       "while read name set; do case $name in CapEff:|CapPrm:|CapInh:|CapAmb:) "
                       "[ $((0x$set & 0x12000ff)) = 0 ] || exit 1;; esac; done < /proc/self/status")),
            0);
}

TEST_F(OwnUserTest, AProcessIsEndedByUsAndNeitherSignalsUsNorAnotherUser) {
  auto other = Process::spawn(as(other_user, "exec sleep 600"));
  ASSERT_TRUE(other) << other.error().text;
  const std::string signals = "kill -0 " + std::to_string(other->pid()) + " 2>/dev/null";
  EXPECT_NE(code_of(as(one_user, signals)), 0);
  EXPECT_NE(code_of(as(one_user, "kill -0 " + std::to_string(::getpid()) + " 2>/dev/null")), 0);
  EXPECT_EQ(code_of(as(other_user, signals)), 0) << "its own it may";
  EXPECT_THAT(process_of_users(other_user, other_user), HasSubstr("(" + std::to_string(other->pid()) + ")"));
  EXPECT_TRUE(other->send_signal(0));
  sched_param ordinary{};
  EXPECT_EQ(::sched_setscheduler(other->pid(), SCHED_OTHER, &ordinary), 0)
      << "the guard takes what it has of real time";
  EXPECT_TRUE(other->send_signal(SIGKILL));
  EXPECT_EQ(code_of(*other), SIGKILL);
}

TEST_F(OwnUserTest, AProcessHasTheRealTimeThatWeHave) {
  const bool ours = realtime_permitted();
  ProcessStart start = as(one_user, "exec chrt --fifo 1 true");
  start.limits.realtime_priority = 50;
  EXPECT_EQ(code_of(start) == 0, ours);
}

TEST_F(OwnUserTest, AProcessOpensWhatIsItsOwnAndNothingOfAnother) {
  std::string folder = (std::filesystem::temp_directory_path() / "hirosco-users-XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  ASSERT_EQ(::chown(folder.c_str(), static_cast<uid_t>(-1), one_user), 0);
  ASSERT_EQ(::chmod(folder.c_str(), 0770), 0);
  std::ofstream{folder + "/frames"} << "x";
  ASSERT_EQ(::chmod((folder + "/frames").c_str(), 0666), 0);
  const std::string opens = ": <> " + folder + "/frames";
  EXPECT_EQ(code_of(as(one_user, opens)), 0);
  EXPECT_NE(code_of(as(other_user, opens + " 2>/dev/null")), 0);
  std::filesystem::remove_all(folder);
}

TEST_F(OwnUserTest, NoneIsStartedWithoutTheRight) {
  without_rights([] {
    const auto process = Process::spawn(as(one_user, "true"));
    ASSERT_FALSE(process) << "never as the user that we are";
    EXPECT_EQ(process.error().code, ErrorCode::NotPermitted);
  });
}

}  // namespace
}  // namespace hirosco
