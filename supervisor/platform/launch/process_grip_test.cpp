// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>

#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/platform/launch/system_launcher.hpp"

/// What can be done to a real process, beside what is taken from it and given back (system_launcher_test.cpp).
namespace hirosco::supervisor {
namespace {

/// A process that has done something and rests then until its end.
class GrippedChild {
 public:
  /// `act` answers a thread that lives on, or an empty one.
  explicit GrippedChild(auto act) {
    std::array<int, 2> ready{};
    if (::pipe(ready.data()) != 0) return;
    pid_ = ::fork();
    if (pid_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      const Thread kept = act();
      static_cast<void>(!::write(ready[1], "", 1));
      for (;;) ::pause();
    }
    char done = 0;
    static_cast<void>(!::read(ready[0], &done, 1));
    for (const int end : ready) ::close(end);
    // What was adopted is gone before the grip is used.
    grip_ = grip_of(Process::adopt(pid_).value()).value();
  }
  ~GrippedChild() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  GrippedChild(const GrippedChild&) = delete;
  GrippedChild& operator=(const GrippedChild&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] ProcessGrip& grip() const { return *grip_; }
  [[nodiscard]] int policy() const { return ::sched_getscheduler(pid_) & ~SCHED_RESET_ON_FORK; }
  [[nodiscard]] rlimit realtime_limit() const {
    rlimit limit{};
    EXPECT_EQ(::prlimit(pid_, RLIMIT_RTPRIO, nullptr, &limit), 0);
    return limit;
  }
  [[nodiscard]] bool lives() const { return ::waitpid(pid_, nullptr, WNOHANG) == 0; }
  /// Stopped by its own signal, which is where nothing changes any more.
  void stand() const {
    ::kill(pid_, SIGSTOP);
    int status = 0;
    ASSERT_EQ(::waitpid(pid_, &status, WUNTRACED), pid_);
    ASSERT_TRUE(WIFSTOPPED(status));
  }
  /// Ended by its grip; the signal that did it.
  [[nodiscard]] int killed_by() {
    grip_->kill();
    int status = 0;
    EXPECT_EQ(::waitpid(pid_, &status, 0), pid_);
    pid_ = 0;
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  pid_t pid_{-1};
  std::shared_ptr<ProcessGrip> grip_;
};

/// Until the calling thread has had so much of a processor.
void burn(Duration span) {
  timespec had{};
  do ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &had);
  while (std::chrono::seconds{had.tv_sec} + Duration{had.tv_nsec} < span);
}

std::atomic<bool> goes_on{false};

/// A thread of real time where that is permitted, which has had 50 ms and goes on to 200 once it gets SIGUSR1.
Thread burns_in_realtime(const char* name) {
  ::signal(SIGUSR1, [](int) { goes_on = true; });
  std::atomic<bool> done{false};
  auto thread = Thread::start(name, [&done] {
    static_cast<void>(set_shared_priority(1));
    burn(50ms);
    done = true;
    while (!goes_on) ::usleep(1000);
    burn(200ms);
    for (;;) ::pause();
  });
  while (!done) ::usleep(1000);
  return std::move(*thread);
}

TEST(ProcessGrip, ProcessorTimeIsThatOfAllThreadsAndLoopsOfRealTimeAreAllButTheCycle) {
  const bool permitted = realtime_permitted();
  for (const char* const name : {"worker", "cycle", "cycle) R 1", "cycles"}) {
    const GrippedChild child{[name] { return burns_in_realtime(name); }};
    EXPECT_EQ(child.grip().loop_time().realtime, 0ms) << "nobody has looked yet";
    child.grip().find_threads();
    EXPECT_EQ(child.grip().loop_time().realtime / 40ms, 0) << "what it had before it was found is of no window";
    ::kill(child.pid(), SIGUSR1);
    while (child.grip().processor_time() < 200ms) ::sched_yield();
    child.stand();
    const LoopTime time = child.grip().loop_time();
    EXPECT_EQ(time.service / 50ms, 0) << "its first thread only waited";
    const bool counts = permitted && std::string_view{name} != "cycle";
    EXPECT_EQ(time.realtime / 50ms > 0, counts) << name;
  }
}

TEST(ProcessGrip, WithoutADescriptorToLookByItKeepsWhatItKnows) {
  const GrippedChild child{[] { return burns_in_realtime("worker"); }};
  child.grip().find_threads();
  ::kill(child.pid(), SIGUSR1);
  while (child.grip().processor_time() < 200ms) ::sched_yield();
  child.stand();
  const LoopTime before = child.grip().loop_time();
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlimit none{.rlim_cur = 0, .rlim_max = limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  child.grip().find_threads();
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_EQ(child.grip().loop_time().realtime, before.realtime);
}

TEST(ProcessGrip, WhatALoopCallsItselfDeceivesNobody) {
  const GrippedChild child{[] {
    ::prctl(PR_SET_NAME, "x) R 1 (y");
    return Thread{};
  }};
  child.stand();
  child.grip().find_threads();
  EXPECT_FALSE(child.grip().loop_time().runnable);
}

TEST(ProcessGrip, WhoseRealTimeIsTakenTakesItNotAgainAndMayHaveItWhenItIsGivenBack) {
  const GrippedChild child{[] {
    rlimit limit{.rlim_cur = 7, .rlim_max = 7};
    if (::setrlimit(RLIMIT_RTPRIO, &limit) == 0) return Thread{};
    ::getrlimit(RLIMIT_RTPRIO, &limit);
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_RTPRIO, &limit);
    return Thread{};
  }};
  const rlim_t most = child.realtime_limit().rlim_max;
  child.grip().take_loops_realtime();
  EXPECT_EQ(child.realtime_limit().rlim_cur, most) << "its cycle keeps what it has";
  child.grip().take_realtime();
  EXPECT_EQ(child.realtime_limit().rlim_cur, 0U);
  EXPECT_EQ(child.realtime_limit().rlim_max, most) << "who is not privileged could not raise it again";
  child.grip().give_realtime();
  EXPECT_EQ(child.realtime_limit().rlim_cur, most);
}

TEST(ProcessGrip, WhoHasNoneLosesNoneAndLivesOn) {
  const GrippedChild child{[] { return Thread{}; }};
  child.grip().take_loops_realtime();
  child.grip().take_realtime();
  child.grip().give_realtime();
  EXPECT_EQ(child.policy(), SCHED_OTHER);
  EXPECT_TRUE(child.lives());
}

TEST(ProcessGrip, WhatAThreadWasGivenSinceIsNotReplacedByWhatItHadBefore) {
  const GrippedChild child{[] {
    static_cast<void>(set_fifo_priority(1));
    return Thread{};
  }};
  child.grip().take_realtime();
  ASSERT_EQ(child.policy(), SCHED_OTHER);
  const sched_param none{};
  const int flag = ::sched_getscheduler(child.pid()) & SCHED_RESET_ON_FORK;
  ASSERT_EQ(::sched_setscheduler(child.pid(), SCHED_BATCH | flag, &none), 0);
  child.grip().give_realtime();
  EXPECT_EQ(child.policy(), SCHED_BATCH);
}

TEST(ProcessGrip, WhatWasGivenBackIsNotGivenBackAgain) {
  const GrippedChild child{[] {
    static_cast<void>(set_fifo_priority(1));
    return Thread{};
  }};
  child.grip().take_realtime();
  child.grip().give_realtime();
  const sched_param none{};
  const int flag = ::sched_getscheduler(child.pid()) & SCHED_RESET_ON_FORK;
  ASSERT_EQ(::sched_setscheduler(child.pid(), SCHED_OTHER | flag, &none), 0);
  child.grip().give_realtime();
  EXPECT_EQ(child.policy(), SCHED_OTHER) << "it laid it down itself";
}

TEST(ProcessGrip, EndsOneThatStandsStillThoughWhatItWasMadeOfIsGone) {
  GrippedChild child{[] { return Thread{}; }};
  child.stand();
  EXPECT_EQ(child.killed_by(), SIGKILL);
}

TEST(ProcessGrip, OfOneThatHasEndedNothingIsToldAndNothingIsDone) {
  GrippedChild child{[] {
    burn(100ms);
    return Thread{};
  }};
  ASSERT_GE(child.grip().processor_time(), 100ms);
  ASSERT_EQ(child.killed_by(), SIGKILL);
  EXPECT_EQ(child.grip().processor_time(), 0ms);
  child.grip().take_realtime();
  child.grip().give_realtime();
  child.grip().kill();
  const LoopTime time = child.grip().loop_time();
  EXPECT_EQ(time.service, 0ms);
  EXPECT_EQ(time.realtime, 0ms);
  EXPECT_FALSE(time.runnable);
}

TEST(ProcessGrip, OneThatHasEndedBeforeItWasGrippedIsGrippedAllTheSame) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  const auto process = Process::adopt(child);
  ASSERT_TRUE(process);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  const auto grip = grip_of(*process);
  ASSERT_TRUE(grip);
  EXPECT_EQ((*grip)->processor_time(), 0ms);
  EXPECT_EQ((*grip)->loop_time().service, 0ms);
  (*grip)->kill();
}

}  // namespace
}  // namespace hirosco::supervisor
