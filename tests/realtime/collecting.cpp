// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Who has real time is held by nobody whom it has displaced while he looked at a process that ends (docs/adr/0240). On one processor: a thread
// of real time collects children one after the other, another one below it looks at them all the time as `top` does. That it is held
// without the collector is tried first. Its argument is the program that judges reasons to skip it.
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/process_threads.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

constexpr int above = 3, collects = 2, looks = 1;
constexpr Duration held_for = 300ms;

/// A child of seven threads, which ends a moment later on any processor.
pid_t child_of_many_threads() {
  const pid_t child = ::fork();
  if (child != 0) return child;
  for (int i = 0; i < 6; ++i)
    if (auto thread = Thread::start("rests", [] {
          for (;;) ::pause();
        }))
      thread->leave_behind();
  sleep_until(SystemClock{}.now() + 300us);
  ::_exit(0);
}

/// Between those who take part.
struct Shared {
  std::atomic<int> child{0};
  std::atomic<int> collector{0};  ///< who collects
  std::atomic<std::int64_t> since{0};  ///< when it began; 0: it does not
  std::atomic<bool> over{false};
};

void look_at(int process) {
  std::array<char, 512> text;
  ProcessThreads threads = ProcessThreads::of(process);
  threads.each([&](int thread) {
    for (const char* const file : {"comm", "stat", "children"})
      if (const FileDescriptor each = threads.open(thread, file))
        static_cast<void>(!::read(each.get(), text.data(), text.size()));
  });
}

/// How it went. Who is held for too long is let go by taking its real time.
struct Watched {
  std::atomic<int> held{0};
  Duration longest{};
  int children{0};
};

using Collect = std::function<void(int child, Process& process)>;

void watch(Watched& found, const Collect& collect, int children) {
  Shared shared;
  const SystemClock clock;
  auto looker = Thread::start("looks", [&] {
    static_cast<void>(pin_to_cycle_cpu());
    static_cast<void>(set_fifo_priority(looks));
    while (!shared.over) {
      if (const int child = shared.child; child != 0) look_at(child);
      sleep_until(clock.now() + 20us);
    }
  });
  auto watcher = Thread::start("watches", [&] {
    static_cast<void>(set_fifo_priority(above));
    while (!shared.over) {
      sleep_until(clock.now() + 10ms);
      const std::int64_t since = shared.since;
      if (since == 0 || clock.now().time_since_epoch().count() - since < held_for.count()) continue;
      ++found.held;
      const sched_param none{};
      ::sched_setscheduler(shared.collector, SCHED_OTHER, &none);
      while (shared.since == since) sleep_until(clock.now() + 1ms);
    }
  });
  auto collector = Thread::start("collects", [&] {
    shared.collector = static_cast<int>(::syscall(SYS_gettid));
    static_cast<void>(pin_to_cycle_cpu());
    for (; found.children < children && found.held == 0; ++found.children) {
      static_cast<void>(set_fifo_priority(collects));
      const pid_t child = child_of_many_threads();
      auto process = Process::adopt(child);
      shared.child = child;
      pollfd end{process->handle().get(), POLLIN, 0};
      ::poll(&end, 1, -1);
      const TimePoint begin = clock.now();
      shared.since = begin.time_since_epoch().count();
      collect(child, *process);
      found.longest = std::max(found.longest, clock.now() - begin);
      shared.since = 0;
    }
    shared.over = true;
  });
  for (auto* const thread : {&looker, &watcher, &collector}) (*thread)->join();
}

void tell(const char* who, const Watched& found) {
  std::printf("%s: %d children, held %d times, %.3f ms at most\n", who, found.children, found.held.load(),
              1e3 * std::chrono::duration<double>(found.longest).count());
}

}  // namespace
}  // namespace hirosco

int main(int count, char** arguments) {
  using namespace hirosco;
  if (count != 2) return 2;
  if (!begin_collecting()) return 3;
  if (!realtime_permitted()) return ::execl(arguments[1], arguments[1], "no-realtime", nullptr);
  constexpr int tries = 400;
  Watched itself, by_another;
  watch(itself, [](int child, Process&) { ::waitpid(child, nullptr, 0); }, tries);
  tell("by itself", itself);
  watch(by_another, [](int, Process& process) { static_cast<void>(process.poll()); }, tries);
  tell("by another thread", by_another);
  if (by_another.held > 0) {
    std::puts("who collects by another thread was held");
    return 1;
  }
  if (itself.held == 0) std::puts("nobody is held on this computer, who collects by itself neither");
  return 0;
}
