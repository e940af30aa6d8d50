// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/process_watch.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <memory>

#include "hirosco/utilities/os/processor_set.hpp"

/// Of real processes: what is told of them, and when.
namespace hirosco::supervisor {
namespace {

/// A process that rests until it is killed.
class Resting {
 public:
  Resting() {
    pid_ = ::fork();
    if (pid_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      for (;;) ::pause();
    }
  }
  ~Resting() { kill(); }
  Resting(const Resting&) = delete;
  Resting& operator=(const Resting&) = delete;
  void add(ProcessWatch& watch, std::uint32_t number, std::shared_ptr<ProcessGrip> grip = nullptr) const {
    watch.add(number, pid_, FileDescriptor{static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0))}, std::move(grip));
  }
  [[nodiscard]] pid_t pid() const { return pid_; }
  void kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }

 private:
  pid_t pid_{0};
};

struct CountedGrip final : ProcessGrip {
  std::atomic<int> asked{0};
  void take_realtime() noexcept override {}
  void take_loops_realtime() noexcept override {}
  void give_realtime() noexcept override {}
  void find_threads() noexcept override { ++asked; }
  [[nodiscard]] LoopTime loop_time() noexcept override { return {}; }
  [[nodiscard]] Duration processor_time() noexcept override { return {}; }
  void kill() noexcept override {}
};

ProcessUsage seen(ProcessWatch& watch, std::uint32_t number) {
  for (;;)
    if (const auto usage = watch.usage(number); usage && usage->look > 0) return *usage;
    else ::sched_yield();
}

TEST(ProcessWatch, TellsOfEachWhatItTakesOnceItHasBeenSeen) {
  ProcessWatch watch;
  const Resting one, other;
  one.add(watch, 7);
  other.add(watch, 3);
  for (const std::uint32_t number : {3U, 7U}) {
    const ProcessUsage usage = seen(watch, number);
    EXPECT_GT(usage.resident_kb, 0U);
    EXPECT_EQ(usage.threads, 1U);
    EXPECT_EQ(usage.processes, 1U);
  }
  EXPECT_FALSE(watch.usage(4)) << "it is none of these";
}

TEST(ProcessWatch, TellsWhatTimeItHasHadBeforeItHasBeenSeen) {
  ProcessWatch watch;
  ASSERT_TRUE(watch.looks());
  const Resting child;
  child.add(watch, 1);
  const auto usage = watch.usage(1);
  ASSERT_TRUE(usage);
  EXPECT_GE(seen(watch, 1).processor, usage->processor);
}

TEST(ProcessWatch, EachQuestionHasItLookedAtAgainWithItsThreads) {
  ProcessWatch watch;
  const Resting child;
  const auto grip = std::make_shared<CountedGrip>();
  child.add(watch, 1, grip);
  for (int looks = 0; looks < 5;) {
    static_cast<void>(watch.usage(1));
    if (grip->asked > looks) ++looks;
    else ::sched_yield();
  }
}

TEST(ProcessWatch, OfOneThatHasEndedOrWasTakenFromItNothingIsTold) {
  ProcessWatch watch;
  Resting child;
  child.add(watch, 1);
  static_cast<void>(seen(watch, 1));
  child.kill();
  EXPECT_FALSE(watch.usage(1));
  const Resting another;
  another.add(watch, 2);
  static_cast<void>(seen(watch, 2));
  watch.remove(2);
  EXPECT_FALSE(watch.usage(2));
  EXPECT_FALSE(watch.stray(2, {}));
  watch.remove(2);
}

TEST(ProcessWatch, AThreadThatMayGoWhereItMayNotIsTold) {
  ProcessWatch watch;
  const Resting child;
  child.add(watch, 1);
  const ProcessorSet used = ProcessorSet::of_thread(child.pid());
  static_cast<void>(seen(watch, 1));
  EXPECT_FALSE(watch.stray(1, {.all = used})) << "it was not asked before";
  static_cast<void>(watch.stray(1, {.all = {}}));
  std::optional<StrayThread> found;
  while (!(found = watch.stray(1, {.all = {}}))) ::sched_yield();
  EXPECT_TRUE(used.has(found->processor));
  EXPECT_FALSE(watch.stray(1, {.all = used})) << "it was seen by other places";
}

TEST(ProcessWatch, EndsThoughSomebodyIsStillToBeLookedAt) {
  const Resting child;
  ProcessWatch watch;
  for (std::uint32_t number = 1; number < 50; ++number) child.add(watch, number);
}

}  // namespace
}  // namespace hirosco::supervisor
