// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <sched.h>

#include "hirosco/utilities/os/thread_hold.hpp"

namespace hirosco {

void ThreadHold::remember() noexcept {}

ThreadHold::Scheduling ThreadHold::scheduling() const noexcept {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  if (pthread_getschedparam(handle_, &policy, &parameters) != 0 || (policy != SCHED_FIFO && policy != SCHED_RR))
    return {};
  return {policy, parameters.sched_priority};
}

bool ThreadHold::schedule(const Scheduling& as) const noexcept {
  sched_param parameters{};
  parameters.sched_priority = as.priority;
  return pthread_setschedparam(handle_, as.priority == 0 ? SCHED_OTHER : as.policy, &parameters) == 0;
}

}  // namespace hirosco
