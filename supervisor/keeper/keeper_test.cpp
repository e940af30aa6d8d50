// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/utilities/os/clock.hpp"
#include "supervisor/keeper/keeper.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

/// Keeper and supervisor look at each other's counter on a page that both may write (hazards SF18 and SF19). And the keeper with a shell in
/// the place of its supervisor, and nobody who reads its standard error.
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

TEST(Progress, BeforeTheFirstStepNobodyStandsStill) {
  Progress progress;
  for (TimePoint now{1s}; now < TimePoint{60s}; now += 100ms) EXPECT_FALSE(progress.stands_still(0, now));
}

TEST(Progress, OfOneThatGoesOnWithAFlightTheFirstStepIsAwaitedSoLongAndNoLonger) {
  Progress progress{supervisor_patience, successor_patience};
  TimePoint now{1s};
  for (; now <= TimePoint{1s} + successor_patience; now += 100ms) EXPECT_FALSE(progress.stands_still(0, now));
  EXPECT_TRUE(progress.stands_still(0, now));
  Progress other{supervisor_patience, successor_patience};
  EXPECT_FALSE(other.stands_still(0, TimePoint{1s}));
  EXPECT_FALSE(other.stands_still(1, TimePoint{1s} + 100ms));
  EXPECT_FALSE(other.stands_still(1, TimePoint{1s} + 500ms));
  EXPECT_FALSE(other.stands_still(1, TimePoint{1s} + 900ms));
  EXPECT_TRUE(other.stands_still(1, TimePoint{1s} + 1s)) << "once it has begun, as any other";
}

/// Looks every 100 ms from then to the end.
bool looks(Progress& progress, std::uint64_t count, TimePoint from, TimePoint end) {
  bool still = false;
  for (TimePoint now = from; now <= end; now += 100ms) still = progress.stands_still(count, now);
  return still;
}

TEST(Progress, StandsStillOnceItsPatienceIsOverAndNoLongerWhenItMoves) {
  Progress progress;
  EXPECT_FALSE(progress.stands_still(5, TimePoint{10s}));
  EXPECT_FALSE(looks(progress, 5, TimePoint{10s}, TimePoint{10s} + keeper_patience));
  EXPECT_TRUE(progress.stands_still(5, TimePoint{10s} + keeper_patience + 1ms));
  EXPECT_FALSE(progress.stands_still(6, TimePoint{14s}));
}

TEST(Progress, APauseOfTheWholeComputerIsNoStandstill) {
  Progress progress;
  EXPECT_FALSE(looks(progress, 5, TimePoint{10s}, TimePoint{12s}));
  EXPECT_FALSE(progress.stands_still(5, TimePoint{100s}));
  EXPECT_FALSE(looks(progress, 6, TimePoint{100s}, TimePoint{102s}));
  EXPECT_TRUE(looks(progress, 6, TimePoint{102s}, TimePoint{104s})) << "whoever stands is seen afterwards";
}

TEST(Progress, NoDamageOfTheCounterHidesThatItStandsStillForLongerThanOnePatience) {
  constexpr std::uint64_t count = 0x1234;
  std::vector<std::uint64_t> damages{0, ~std::uint64_t{0}, ~count, 1, count - 1};
  for (unsigned bit = 0; bit < 64; ++bit) damages.push_back(count ^ std::uint64_t{1} << bit);
  for (const std::uint64_t damaged : damages) {
    Progress progress;
    EXPECT_FALSE(progress.stands_still(count, TimePoint{10s}));
    EXPECT_FALSE(progress.stands_still(damaged, TimePoint{11s}));
    EXPECT_TRUE(looks(progress, damaged, TimePoint{11s}, TimePoint{11s} + keeper_patience + 100ms)) << damaged;
  }
}

/// What stands in the keeper's page first: its layout, the keeper's count and the supervisor's (kept.hpp). A shell that writes there has moved.
constexpr const char* moves = "printf llllllllaaaaaaaabbbbbbbb >&7; ";

struct KeeperTest : ::testing::Test {
  TestFolder folder;
  std::string starts{(folder.path() / "starts").string()};
  FileDescriptor unread, full;

  void SetUp() override {
    std::array<int, 2> ends{-1, -1};
    ASSERT_EQ(::pipe(ends.data()), 0);
    unread.reset(ends[0]);
    full.reset(ends[1]);
    ASSERT_EQ(::fcntl(full.get(), F_SETFL, O_NONBLOCK), 0);
    while (::write(full.get(), "#", 1) == 1) {}
    ASSERT_EQ(::fcntl(full.get(), F_SETFL, 0), 0);  // as those who share it have it
  }
  /// How a keeper ended that was started with this for its supervisor, each of which notes its start. Whoever stands still is ended by a
  /// signal in the end, and so is who was stopped.
  [[nodiscard]] int kept(const std::string& supervisor) {
    const pid_t keeper = ::fork();
    if (keeper == 0) {
      static_cast<void>(::setpgid(0, 0));  // a group whose parent is outside it: job control reaches it
      ::dup2(full.get(), STDERR_FILENO);
      full.reset();
      if (!unread_stays) unread.reset();
      ::alarm(20);
      KeeperPlan plan;
      plan.supervisor.executable = shell;
      plan.supervisor.arguments = {"-c", "echo $$ >> '" + starts + "'; " + supervisor};
      plan.devices = devices;
      plan.run_for = run_for;
      ::_exit(keep(std::move(plan)));
    }
    if (!unread_stays) unread.reset();
    int how = 0;
    EXPECT_EQ(::waitpid(keeper, &how, WUNTRACED), keeper);
    if (WIFSTOPPED(how)) {
      ::kill(keeper, SIGKILL);
      ::waitpid(keeper, nullptr, 0);
    }
    return how;
  }
  [[nodiscard]] std::size_t supervisors() const {
    std::ifstream lines{starts};
    return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>{lines}, {}, '\n'));
  }
  /// What one of them has written into this file of the folder.
  [[nodiscard]] std::string written(const std::string& name) const {
    std::ifstream file{folder.path() / name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }
  std::vector<ProcessStart> devices;
  std::optional<Duration> run_for;
  bool unread_stays{true};
  std::string shell{"/bin/sh"};  ///< the supervisor's program
};

TEST_F(KeeperTest, EndsASupervisorThatStandsStillThoughNobodyReadsItsStandardError) {
  const int how = kept("kill -STOP $$");
  ASSERT_TRUE(WIFEXITED(how)) << how;
  EXPECT_EQ(WEXITSTATUS(how), 4);
}

TEST_F(KeeperTest, StartsAnotherSupervisorThoughNobodyReadsItsStandardError) {
  const int how = kept(std::string{moves} + "kill -KILL $$");
  ASSERT_TRUE(WIFEXITED(how)) << how;
  EXPECT_EQ(supervisors(), 2U) << "the second one's words say that it has finished";
}

TEST_F(KeeperTest, StartsAnotherSupervisorThoughWhoReadItsStandardErrorIsGone) {
  unread_stays = false;
  const int how = kept(std::string{moves} + "kill -KILL $$");
  ASSERT_TRUE(WIFEXITED(how)) << how;
  EXPECT_EQ(supervisors(), 2U);
}

TEST_F(KeeperTest, HearsAnEndAskedForThoughNobodyReadsItsStandardError) {
  // The first one dies without an end, and what the keeper says of it has no room; the second asks the keeper for one.
  // It begins with SIGTERM blocked, so that it sees it wait.
  const int how =
      kept("if [ $(wc -l < '" + starts + "') = 1 ]; then " + moves +
           "kill -KILL $$; fi; kill -TERM $PPID; until grep -q '^ShdPnd:.*4...$' /proc/$$/status; do :; done");
  ASSERT_TRUE(WIFEXITED(how)) << how;
  EXPECT_EQ(supervisors(), 2U);
}

TEST_F(KeeperTest, TriesAgainWhereTheSystemRefusesToStartAnotherSupervisor) {
  // Its program is gone until the keeper has tried twice, which stands in its page (kept.hpp).
  shell = (folder.path() / "shell").string();
  std::filesystem::copy_file("/bin/sh", shell);
  const std::string away = shell + ".away", starts_at = std::to_string(offsetof(KeeperPage, starts));
  const int how = kept("if [ $(wc -l < '" + starts + "') = 1 ]; then " + moves + "mv '" + shell + "' '" + away +
                       "'; (until [ $(od -An -tu4 -j" + starts_at + " -N4 /proc/self/fd/7) -ge 3 ]; do :; done; mv '" +
                       away + "' '" + shell + "') & kill -KILL $$; fi; " + moves);
  ASSERT_TRUE(WIFEXITED(how)) << how;
  EXPECT_EQ(supervisors(), 2U) << "the second one's words say that it has finished";
}

TEST_F(KeeperTest, EndsASuccessorThatNeverTakesItsFirstStep) {
  const int how = kept("case $(wc -l < '" + starts + "') in 1) " + moves +
                       "kill -KILL $$ ;; 2) while :; do :; done ;; esac; " + moves);
  ASSERT_TRUE(WIFEXITED(how)) << how;
  EXPECT_EQ(supervisors(), 3U) << "the third one's words say that it has finished";
}

TEST_F(KeeperTest, GivesTheSupervisorTheEndOfThePipeByWhichDevicesKnowThatTheyAreAlone) {
  const std::string of_device = (folder.path() / "device").string(),
                    of_supervisor = (folder.path() / "supervisor").string();
  const auto pipe_of = [](const std::string& number, const std::string& into) {
    return "readlink /proc/$$/fd/" + number + " > '" + into + "'; ";
  };
  devices.push_back({.executable = "/bin/sh", .arguments = {"-c", pipe_of("0", of_device) + "exec cat"}});
  const int how = kept(moves + pipe_of(std::to_string(flight_held_descriptor), of_supervisor) +
                       pipe_of(std::to_string(keeper_descriptor), of_supervisor + ".keeper") + "until [ -s '" +
                       of_device + "' ]; do :; done");
  ASSERT_TRUE(WIFEXITED(how)) << how;
  EXPECT_NE(written("device"), "");
  EXPECT_EQ(written("device"), written("supervisor")) << "while one of the two lives it does not end";
  EXPECT_NE(written("device"), written("supervisor.keeper")) << "the supervisor knows of the keeper alone";
}

TEST_F(KeeperTest, TellsTheSupervisorWhenTheTimeOfItsFlightIsOver) {
  run_for = 1h;
  const SystemClock clock;
  const auto in_an_hour = [&] { return (clock.now() + 1h).time_since_epoch().count(); };
  const std::int64_t earliest = in_an_hour();
  const int how = kept(std::string{moves} + "od -An -td8 -j" + std::to_string(offsetof(KeeperPage, ends_at)) +
                       " -N8 /proc/self/fd/7 > '" + (folder.path() / "ends_at").string() + "'");
  ASSERT_TRUE(WIFEXITED(how)) << how;
  const std::int64_t told = std::atoll(written("ends_at").c_str());
  EXPECT_GE(told, earliest);
  EXPECT_LE(told, in_an_hour());
}

TEST_F(KeeperTest, IsStoppedByNoTerminal) {
  const int how = kept("kill -TSTP $PPID; kill -TTIN $PPID; kill -TTOU $PPID");
  ASSERT_FALSE(WIFSTOPPED(how)) << "by signal " << WSTOPSIG(how);
  ASSERT_TRUE(WIFEXITED(how)) << how;
}

}  // namespace
}  // namespace hirosco::supervisor
