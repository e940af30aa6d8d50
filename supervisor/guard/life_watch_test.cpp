// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/life_watch.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hirosco/utilities/os/life.hpp"
#include "supervisor/guard/testing/guard_rig.hpp"

/// The thread, the system's mark and real processes; the pages are shared with them.
namespace hirosco::supervisor {
namespace {

using namespace testing;

struct LifeWatchTest : GuardTest {
  /// One whose page is shared: the process holds the word in it.
  pid_t adopt_process(std::uint16_t apid) {
    void* const shared = ::mmap(nullptr, sizeof(VitalPage), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    testing::Life& life = lives[apid] = testing::Life{};
    life.permit_memory = memory.map(memory.create("permit", sizeof(PermitPage)).value(), Access::ReadWrite).value();
    life.vital = new (shared) VitalPage{};
    life.permit = new (life.permit_memory.octets.data()) PermitPage{};
    life.vital->realtime = 1;
    LaunchedSubsystem launched;
    launched.vital = {nullptr, {static_cast<std::byte*>(shared), sizeof(VitalPage)}};
    launched.permit = life.permit_memory;
    launched.grip = life.process;
    const pid_t child = ::fork();
    if (child == 0) {
      static_cast<void>(hold_life(life.vital->life));
      for (;;) ::pause();
    }
    guard.started(apid, launched);
    return child;
  }
  /// Until the guard has seen who lives, and then until it has fenced `apid`: what is waited for ends the wait.
  void until_fenced(std::uint16_t apid) {
    while (may_move(apid)) ::usleep(100);
  }
  void let_move(std::uint16_t apid) {
    cycling(apid);
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
};

TEST_F(LifeWatchTest, AKilledProcessIsFencedWithItsNetworkBeforeItIsReaped) {
  auto started = LifeWatch::start(guard);
  ASSERT_TRUE(started) << started.error().text;
  for (int again = 0; again < 3; ++again) {
    static_cast<void>(guard.take_findings());  // the supervisor has heard of the last end
    const pid_t child = adopt_process(arm);
    while (life_of(lives[arm].vital->life.load()) != hirosco::Life::Held) ::usleep(100);
    let_move(arm);
    let_move(hand);
    let_move(camera);
    guard.falls_with(arm, {arm, hand});
    ::kill(child, SIGKILL);
    until_fenced(hand);
    EXPECT_FALSE(may_move(arm));
    EXPECT_TRUE(may_move(camera));
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    guard.forget(arm);
  }
}

TEST_F(LifeWatchTest, EndsWhileItWaits) {
  auto started = LifeWatch::start(guard);
  ASSERT_TRUE(started);
  started->reset();
  SUCCEED() << "joined";
}

}  // namespace
}  // namespace hirosco::supervisor
