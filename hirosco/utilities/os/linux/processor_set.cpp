// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/processor_set.hpp"

#include <sched.h>

#include <cerrno>
#include <cstring>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {

ProcessorSet ProcessorSet::of_this_thread() noexcept { return of_thread(0); }

ProcessorSet ProcessorSet::of_thread(int thread) noexcept {
  static_assert(most == CPU_SETSIZE && sizeof words_ == sizeof(cpu_set_t));
  ProcessorSet found;
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (::sched_getaffinity(thread, sizeof allowed, &allowed) == 0)
    std::memcpy(found.words_.data(), &allowed, sizeof allowed);
  return found;
}

Result<> ProcessorSet::take() const noexcept {
  if (count() == 0) return fail(ErrorCode::Unavailable, "it is not known which processors it could use");
  cpu_set_t allowed;
  std::memcpy(&allowed, words_.data(), sizeof allowed);
  if (::sched_setaffinity(0, sizeof allowed, &allowed) != 0)
    return fail(ErrorCode::SystemFailure, "processor affinity", errno);
  return ok();
}

bool grants_processor(unsigned processor) noexcept {
  const ProcessorSet before = ProcessorSet::of_this_thread();
  const bool granted = pin_to_cpu(processor).has_value();
  if (granted) static_cast<void>(before.take());
  return granted;
}

}  // namespace hirosco
