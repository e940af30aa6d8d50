// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <new>
#include <span>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

constexpr std::size_t stack_octets = std::size_t{64} * 1024;
/// For one that was ended and takes its time.
constexpr Duration look_again = std::chrono::milliseconds{20};

[[nodiscard]] bool has_realtime() noexcept {
  const int policy = ::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  return policy == SCHED_FIFO || policy == SCHED_RR;
}

/// Whether it is a child of ours that is still there, ended or not.
[[nodiscard]] bool is_there(int pid) noexcept {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0;
}

/// Those that whoever has real time leaves to others.
class Collector {
 public:
  /// As long as the process: nobody waits for its thread. Takes nothing from the heap.
  [[nodiscard]] static Collector& of_process() noexcept {
    alignas(Collector) static std::array<std::byte, sizeof(Collector)> room;
    static auto* const collector = ::new (room.data()) Collector;
    return *collector;
  }
  [[nodiscard]] Result<> begin() noexcept {
    const LockGuard lock{mutex_};
    if (runs_) return ok();
    try {
      HIROSCO_TRY_LET(auto thread, Thread::start("collector", [this] { run(); }, stack_octets));
      thread.leave_behind();
    } catch (const std::bad_alloc&) {
      return fail(ErrorCode::ResourceExhausted, "thread that collects processes");
    }
    runs_ = true;
    return ok();
  }
  [[nodiscard]] Collection take(int pid) noexcept {
    const bool runs = begin().has_value();
    const LockGuard lock{mutex_};
    const auto under_way = std::span{waiting_}.first(count_);
    // Under the lock: one that is not in the list any more and is gone was collected since it was seen to have ended.
    if (std::ranges::find(under_way, pid) != under_way.end() || !is_there(pid)) return Collection::UnderWay;
    if (count_ == waiting_.size() || !runs) return Collection::NotNow;
    waiting_[count_++] = pid;
    there_is_one_.post();
    return Collection::Begun;
  }

 private:
  [[noreturn]] void run() noexcept {
    sigset_t all;
    sigfillset(&all);
    (void)::pthread_sigmask(SIG_SETMASK, &all, nullptr);
    (void)set_background_scheduling();
    for (;;) {
      if (nobody_waits()) there_is_one_.wait();
      else (void)there_is_one_.wait_until(SystemClock{}.now() + look_again);
      collect_all();
    }
  }
  [[nodiscard]] bool nobody_waits() noexcept {
    const LockGuard lock{mutex_};
    return count_ == 0;
  }
  /// Those that have ended. Nobody is held up by one that has not.
  void collect_all() noexcept {
    std::array<int, most> wanted;
    const auto count = [&] {
      const LockGuard lock{mutex_};
      std::ranges::copy(waiting_, wanted.begin());
      return count_;
    }();
    for (const int pid : std::span{wanted}.first(count))
      if (::waitpid(pid, nullptr, WNOHANG) != 0) drop(pid);
  }
  void drop(int pid) noexcept {
    const LockGuard lock{mutex_};
    const auto all = std::span{waiting_}.first(count_);
    count_ = static_cast<std::size_t>(std::ranges::remove(all, pid).begin() - all.begin());
  }

  static constexpr std::size_t most = 256;
  Mutex mutex_;
  Semaphore there_is_one_;
  std::array<int, most> waiting_ HIROSCO_GUARDED_BY(mutex_){};
  std::size_t count_ HIROSCO_GUARDED_BY(mutex_){0};
  bool runs_ HIROSCO_GUARDED_BY(mutex_){false};
};

}  // namespace

Result<> begin_collecting() noexcept { return Collector::of_process().begin(); }

Collection collect(int pid) noexcept {
  if (pid <= 0) return Collection::UnderWay;
  if (has_realtime()) return Collector::of_process().take(pid);
  int outcome = 0;
  do {
    outcome = ::waitpid(pid, nullptr, 0);
  } while (outcome < 0 && errno == EINTR);
  return outcome > 0 ? Collection::Begun : Collection::UnderWay;
}

}  // namespace hirosco
