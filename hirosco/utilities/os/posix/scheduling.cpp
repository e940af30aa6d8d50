// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {

Result<> set_fifo_priority(int priority) noexcept {
  if (priority < sched_get_priority_min(SCHED_FIFO) || priority > sched_get_priority_max(SCHED_FIFO))
    return fail(ErrorCode::OutOfRange, "FIFO priority", priority);
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters); error != 0)
    return fail(ErrorCode::SystemFailure, "FIFO scheduling", error);
  return ok();
}

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
  if (policy == SCHED_FIFO) return true;
  sched_param lowest{};
  lowest.sched_priority = sched_get_priority_min(SCHED_FIFO);
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &lowest) != 0) return false;
  (void)pthread_setschedparam(pthread_self(), policy, &before);
  return true;
}

Result<> pin_to_cycle_cpu() noexcept { return fail(ErrorCode::Unavailable, "POSIX has no processor affinity"); }
Result<> pin_to_cpu(unsigned cpu) noexcept {
  return fail(ErrorCode::Unavailable, "POSIX has no processor affinity", cpu);
}

void set_thread_name(const char* /*name*/) noexcept {}

}  // namespace hirosco
