// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

#include "hirosco/utilities/os/thread_hold.hpp"

// By the kernel's number, for the reasons of thread_scheduling.cpp.
namespace hirosco {

void ThreadHold::remember() noexcept { number_ = static_cast<int>(::syscall(SYS_gettid)); }

ThreadHold::Scheduling ThreadHold::scheduling() const noexcept {
  const int policy = std::max(::sched_getscheduler(number_), 0);
  sched_param parameters{};
  if (::sched_getparam(number_, &parameters) != 0) return {};
  return {policy, parameters.sched_priority};
}

bool ThreadHold::schedule(const Scheduling& as) const noexcept {
  // What the thread has of this flag an ordinary user may not take away.
  const int flag = std::max(::sched_getscheduler(number_), 0) & SCHED_RESET_ON_FORK;
  sched_param parameters{};
  parameters.sched_priority = as.priority;
  return ::sched_setscheduler(number_, (as.priority == 0 ? SCHED_OTHER : as.policy) | flag, &parameters) == 0;
}

}  // namespace hirosco
