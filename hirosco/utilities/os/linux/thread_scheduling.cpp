// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "hirosco/utilities/os/thread.hpp"

// Throughout by sched_*() with 0, the calling thread: pthread_getschedparam() answers from a cache that these do not
// refresh, and pthread_setschedparam() knows no SCHED_RESET_ON_FORK.
namespace hirosco {
namespace {

/// struct sched_attr of the kernel (its header redefines what <sched.h> defines).
struct SchedulingWish {
  std::uint32_t size{sizeof(SchedulingWish)};
  std::uint32_t policy{SCHED_OTHER};
  std::uint64_t flags{0};
  std::int32_t nice{0};
  std::uint32_t priority{0};
  std::uint64_t runtime_ns{0};
  std::uint64_t deadline_ns{0};
  std::uint64_t period_ns{0};
};
static_assert(sizeof(SchedulingWish) == 48);

constexpr std::uint64_t shortest_slice_ns = 100'000;  // the kernel grants no shorter one

Result<> set_priority(int policy, int priority) noexcept {
  if (priority < sched_get_priority_min(policy) || priority > sched_get_priority_max(policy))
    return fail(ErrorCode::OutOfRange, "real-time priority", priority);
  sched_param parameters{};
  parameters.sched_priority = priority;
  // Without the flag a process we start would compete with our loops.
  if (::sched_setscheduler(0, policy | SCHED_RESET_ON_FORK, &parameters) != 0)
    return fail(ErrorCode::SystemFailure, "real-time scheduling (rtprio limit, or cpu group without rt_runtime)",
                errno);
  return ok();
}

Result<> set_without_priority(int policy) noexcept {
  const sched_param parameters{};
  const int flag = ::sched_getscheduler(0) & SCHED_RESET_ON_FORK;  // only a privileged thread may clear it
  if (::sched_setscheduler(0, policy | flag, &parameters) != 0)
    return fail(ErrorCode::SystemFailure, "ordinary scheduling", errno);
  return ok();
}

}  // namespace

Result<> set_fifo_priority(int priority) noexcept { return set_priority(SCHED_FIFO, priority); }
Result<> set_shared_priority(int priority) noexcept { return set_priority(SCHED_RR, priority); }

Result<> set_ordinary_scheduling() noexcept { return set_without_priority(SCHED_OTHER); }
Result<> set_background_scheduling() noexcept { return set_without_priority(SCHED_BATCH); }

Result<> ask_for_short_slices() noexcept {
  SchedulingWish wish;
  wish.nice = ::getpriority(PRIO_PROCESS, 0);
  wish.runtime_ns = shortest_slice_ns;
  if (::syscall(SYS_sched_setattr, 0, &wish, 0U) != 0) return fail(ErrorCode::Unavailable, "short slices", errno);
  return ok();
}

bool realtime_permitted() noexcept {
  const int policy = ::sched_getscheduler(0);
  sched_param before{};
  if (policy < 0 || ::sched_getparam(0, &before) != 0) return false;
  const int bare = policy & ~SCHED_RESET_ON_FORK;
  if (bare == SCHED_FIFO || bare == SCHED_RR) return true;
  sched_param lowest{};
  lowest.sched_priority = sched_get_priority_min(SCHED_FIFO);
  // An unprivileged thread cannot clear the flag again, so the probe leaves it as it was.
  if (::sched_setscheduler(0, SCHED_FIFO | (policy & SCHED_RESET_ON_FORK), &lowest) != 0) return false;
  (void)::sched_setscheduler(0, policy, &before);
  return true;
}

Result<> pin_to_cycle_cpu() noexcept {
  const auto last = ProcessorSet::of_this_thread().last();
  return last ? pin_to_cpu(*last) : fail(ErrorCode::SystemFailure, "processor affinity");
}

unsigned usable_processors() noexcept {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (pthread_getaffinity_np(pthread_self(), sizeof allowed, &allowed) != 0) return 1;
  return static_cast<unsigned>(CPU_COUNT(&allowed));
}

Result<> pin_to_cpu(unsigned cpu) noexcept {
  if (cpu >= CPU_SETSIZE) return fail(ErrorCode::OutOfRange, "processor", cpu);
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  if (::sched_setaffinity(0, sizeof set, &set) != 0) return fail(ErrorCode::SystemFailure, "processor affinity", errno);
  return ok();
}

void set_thread_name(const char* name) noexcept {
  std::array<char, 16> cut{};
  std::memcpy(cut.data(), name, std::min(std::strlen(name), cut.size() - 1));
  (void)pthread_setname_np(pthread_self(), cut.data());
}

}  // namespace hirosco
