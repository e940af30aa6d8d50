// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/semaphore.hpp"

#include <pthread.h>

#include <cerrno>
#include <limits>
#include <new>

// Not sem_t: POSIX.1-2008 gives it a time limit on the calendar clock only, which may jump.
namespace hirosco {
namespace {

struct State {
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  std::uint32_t count;
};

template <class Storage>
[[nodiscard]] State& state_of(Storage& storage) noexcept {
  static_assert(sizeof(State) <= sizeof(Storage) && alignof(State) <= alignof(Storage));
  return *std::launder(reinterpret_cast<State*>(&storage));
}

class Locked {
 public:
  explicit Locked(State& state) noexcept : state_{state} { (void)pthread_mutex_lock(&state_.mutex); }
  ~Locked() { (void)pthread_mutex_unlock(&state_.mutex); }
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  State& state_;
};

}  // namespace

Semaphore::Semaphore(std::uint32_t initial) noexcept {
  State& state = *new (&storage_) State{};
  state.count = initial;
  pthread_mutexattr_t mutex_attributes;
  (void)pthread_mutexattr_init(&mutex_attributes);
  (void)pthread_mutexattr_setprotocol(&mutex_attributes, PTHREAD_PRIO_INHERIT);
  (void)pthread_mutex_init(&state.mutex, &mutex_attributes);
  (void)pthread_mutexattr_destroy(&mutex_attributes);
  pthread_condattr_t condition_attributes;
  (void)pthread_condattr_init(&condition_attributes);
  (void)pthread_condattr_setclock(&condition_attributes, CLOCK_MONOTONIC);
  (void)pthread_cond_init(&state.changed, &condition_attributes);
  (void)pthread_condattr_destroy(&condition_attributes);
}

Semaphore::~Semaphore() {
  State& state = state_of(storage_);
  (void)pthread_cond_destroy(&state.changed);
  (void)pthread_mutex_destroy(&state.mutex);
}

void Semaphore::post() noexcept {
  State& state = state_of(storage_);
  const Locked locked{state};
  if (state.count != std::numeric_limits<std::uint32_t>::max()) ++state.count;
  (void)pthread_cond_signal(&state.changed);
}

void Semaphore::wait() noexcept {
  State& state = state_of(storage_);
  const Locked locked{state};
  while (state.count == 0) (void)pthread_cond_wait(&state.changed, &state.mutex);
  --state.count;
}

bool Semaphore::try_wait() noexcept {
  State& state = state_of(storage_);
  const Locked locked{state};
  if (state.count == 0) return false;
  --state.count;
  return true;
}

bool Semaphore::wait_until(TimePoint deadline) noexcept {
  State& state = state_of(storage_);
  const auto since_start = deadline.time_since_epoch() > Duration{0} ? deadline.time_since_epoch() : Duration{0};
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_start);
  const timespec limit{static_cast<time_t>(whole.count()), static_cast<long>((since_start - whole).count())};
  const Locked locked{state};
  while (state.count == 0)
    if (pthread_cond_timedwait(&state.changed, &state.mutex, &limit) == ETIMEDOUT && state.count == 0) return false;
  --state.count;
  return true;
}

}  // namespace hirosco
