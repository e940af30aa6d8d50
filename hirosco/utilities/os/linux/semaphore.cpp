// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/semaphore.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <ctime>
#include <limits>
#include <new>

namespace hirosco {
namespace {

/// The kernel compares `count`; `waiters` spares post() the system call when nobody sleeps.
struct State {
  std::atomic<std::uint32_t> count;
  std::atomic<std::uint32_t> waiters;
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free && sizeof(std::atomic<std::uint32_t>) == 4);

template <class Storage>
[[nodiscard]] State& state_of(Storage& storage) noexcept {
  static_assert(sizeof(State) <= sizeof(Storage) && alignof(State) <= alignof(Storage));
  return *std::launder(reinterpret_cast<State*>(&storage));
}

[[nodiscard]] bool take(State& state) noexcept {
  std::uint32_t count = state.count.load(std::memory_order_relaxed);
  while (count != 0)
    if (state.count.compare_exchange_weak(count, count - 1, std::memory_order_seq_cst, std::memory_order_relaxed))
      return true;
  return false;
}

/// FUTEX_WAIT_BITSET takes its limit as a point of CLOCK_MONOTONIC; FUTEX_WAIT would take a span.
[[nodiscard]] int sleep_while_zero(State& state, const timespec* limit) noexcept {
  const long result = ::syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&state.count),
                                FUTEX_WAIT_BITSET | FUTEX_PRIVATE_FLAG, 0U, limit, nullptr, FUTEX_BITSET_MATCH_ANY);
  return result == 0 ? 0 : errno;
}

[[nodiscard]] bool wait_for(State& state, const timespec* limit) noexcept {
  if (take(state)) return true;
  state.waiters.fetch_add(1, std::memory_order_seq_cst);
  bool taken = take(state);
  while (!taken) {
    const int error = sleep_while_zero(state, limit);
    taken = take(state);
    if (!taken && error == ETIMEDOUT) break;
  }
  state.waiters.fetch_sub(1, std::memory_order_seq_cst);
  return taken;
}

}  // namespace

Semaphore::Semaphore(std::uint32_t initial) noexcept { new (&storage_) State{initial, 0}; }

Semaphore::~Semaphore() = default;

void Semaphore::post() noexcept {
  State& state = state_of(storage_);
  std::uint32_t count = state.count.load(std::memory_order_relaxed);
  do {
    if (count == std::numeric_limits<std::uint32_t>::max()) return;
  } while (!state.count.compare_exchange_weak(count, count + 1, std::memory_order_seq_cst, std::memory_order_relaxed));
  if (state.waiters.load(std::memory_order_seq_cst) == 0) return;
  (void)::syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&state.count), FUTEX_WAKE | FUTEX_PRIVATE_FLAG, 1,
                  nullptr, nullptr, 0);
}

void Semaphore::wait() noexcept { (void)wait_for(state_of(storage_), nullptr); }

bool Semaphore::try_wait() noexcept { return take(state_of(storage_)); }

bool Semaphore::wait_until(TimePoint deadline) noexcept {
  const auto since_start = deadline.time_since_epoch() > Duration{0} ? deadline.time_since_epoch() : Duration{0};
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_start);
  const timespec limit{static_cast<time_t>(whole.count()), static_cast<long>((since_start - whole).count())};
  return wait_for(state_of(storage_), &limit);
}

}  // namespace hirosco
