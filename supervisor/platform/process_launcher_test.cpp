// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/process_launcher.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::supervisor {
namespace {

/// A process that has as much real time as it may have, until its end.
pid_t start_realtime() {
  std::array<int, 2> ready{};
  if (::pipe(ready.data()) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    static_cast<void>(set_fifo_priority(1));
    static_cast<void>(!::write(ready[1], "", 1));
    for (;;) ::pause();
  }
  char begun = 0;
  static_cast<void>(!::read(ready[0], &begun, 1));
  for (const int end : ready) ::close(end);
  return child;
}

/// 0: all is as it should be.
int take_realtime_from_another() {
  const pid_t child = start_realtime();
  const auto process = Process::adopt(child);
  if (!process) return 1;
  const auto grip = grip_of(*process);
  if (!grip) return 2;
  (*grip)->take_realtime();
  const int policy = ::sched_getscheduler(child);
  int status = 0;
  if (::waitpid(child, &status, WNOHANG) != 0) return 3;  // it lives on: it has its grace
  (*grip)->kill();
  ::waitpid(child, &status, 0);
  return (policy & ~SCHED_RESET_ON_FORK) == SCHED_OTHER ? 0 : 4;
}

TEST(ProcessGrip, TakesRealTimeAsRoot) { EXPECT_EQ(take_realtime_from_another(), 0); }

TEST(ProcessGrip, TakesRealTimeAsAnOrdinaryUserWhoMayHaveIt) {
  const pid_t user = ::fork();
  if (user == 0) {
    const rlimit most{.rlim_cur = 1, .rlim_max = 1};
    constexpr uid_t nobody = 65'534;
    static_cast<void>(::setrlimit(RLIMIT_RTPRIO, &most));
    if (::getuid() == 0 && (::setgid(nobody) != 0 || ::setuid(nobody) != 0)) ::_exit(9);
    ::_exit(take_realtime_from_another());
  }
  int status = 0;
  ASSERT_EQ(::waitpid(user, &status, 0), user);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace hirosco::supervisor
