// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/thread_hold.hpp"

#include <ctime>
#include <utility>

// What every backend shares; what it asks the system stands in the backend's own file.
namespace hirosco {

void ThreadHold::enter() noexcept {
  const LockGuard lock{mutex_};
  handle_ = pthread_self();
  remember();
  taken_ = {};
  had_before_ = Duration{0};
  present_ = true;
}

void ThreadHold::leave() noexcept {
  const LockGuard lock{mutex_};
  if (!std::exchange(present_, false)) return;
  had_before_ = had();
}

bool ThreadHold::take_realtime() noexcept {
  const LockGuard lock{mutex_};
  if (!present_) return true;
  const Scheduling before = scheduling();
  if (before.priority == 0) return true;
  if (!schedule({})) return false;
  taken_ = before;
  return true;
}

void ThreadHold::give_realtime() noexcept {
  const LockGuard lock{mutex_};
  const Scheduling back = std::exchange(taken_, {});
  if (!present_ || back.priority == 0 || scheduling().priority != 0) return;
  static_cast<void>(schedule(back));
}

bool ThreadHold::has_realtime() noexcept {
  const LockGuard lock{mutex_};
  return present_ && scheduling().priority != 0;
}

Duration ThreadHold::processor_time() noexcept {
  const LockGuard lock{mutex_};
  return present_ ? had() : had_before_;
}

Duration ThreadHold::had() const noexcept {
  clockid_t clock{};
  timespec time{};
  if (pthread_getcpuclockid(handle_, &clock) != 0 || clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
}

}  // namespace hirosco
