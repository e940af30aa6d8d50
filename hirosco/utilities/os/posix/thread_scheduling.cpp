// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {

namespace {

Result<> set_priority(int policy, int priority) noexcept {
  if (priority < sched_get_priority_min(policy) || priority > sched_get_priority_max(policy))
    return fail(ErrorCode::OutOfRange, "real-time priority", priority);
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (const int error = pthread_setschedparam(pthread_self(), policy, &parameters); error != 0)
    return fail(ErrorCode::SystemFailure, "real-time scheduling", error);
  return ok();
}

}  // namespace

Result<> set_fifo_priority(int priority) noexcept { return set_priority(SCHED_FIFO, priority); }
Result<> set_shared_priority(int priority) noexcept { return set_priority(SCHED_RR, priority); }

Result<> set_background_scheduling() noexcept { return set_ordinary_scheduling(); }

Result<> set_ordinary_scheduling() noexcept {
  const sched_param parameters{};
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameters); error != 0)
    return fail(ErrorCode::SystemFailure, "ordinary scheduling", error);
  return ok();
}

Result<> ask_for_short_slices() noexcept { return fail(ErrorCode::Unavailable, "POSIX has no slices"); }

bool realtime_permitted() noexcept {
  int policy = 0;
  sched_param before{};
  if (pthread_getschedparam(pthread_self(), &policy, &before) != 0) return false;
  if (policy == SCHED_FIFO || policy == SCHED_RR) return true;
  sched_param lowest{};
  lowest.sched_priority = sched_get_priority_min(SCHED_FIFO);
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &lowest) != 0) return false;
  (void)pthread_setschedparam(pthread_self(), policy, &before);
  return true;
}

Result<> pin_to_cycle_cpu() noexcept { return fail(ErrorCode::Unavailable, "POSIX has no processor affinity"); }
unsigned usable_processors() noexcept { return 1; }
Result<> pin_to_cpu(unsigned cpu) noexcept {
  return fail(ErrorCode::Unavailable, "POSIX has no processor affinity", cpu);
}

void set_thread_name(const char* /*name*/) noexcept {}

}  // namespace hirosco
