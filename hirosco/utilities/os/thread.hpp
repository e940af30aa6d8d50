// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "hirosco/utilities/os/processor_set.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// A thread that is joined at the latest by its destructor. An exception that leaves its body ends the process.
/// Thread: its owner. Realtime: blocks, allocates.
class Thread {
 public:
  /// `body` may be what can only be moved. `name` shows in the tools of the operating system (15 octets there); `stack_octets` 0 is
  /// the system's own choice.
  template <class Body>
  [[nodiscard]] static Result<Thread> start(std::string name, Body body, std::size_t stack_octets = 0) {
    // Not std::move_only_function: not every standard library has it yet.
    auto kept = std::make_shared<Body>(std::move(body));
    return begin(std::move(name), [kept = std::move(kept)] { (*kept)(); }, stack_octets);
  }
  Thread() = default;
  Thread(Thread&& other) noexcept;
  Thread& operator=(Thread&& other) noexcept;
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  ~Thread() { join(); }

  [[nodiscard]] bool joinable() const noexcept { return joinable_; }
  /// Returns when the body has ended; at once when there is none.
  void join() noexcept;
  /// Nobody waits for it any more: its body goes on by itself, with nothing but what it holds.
  void leave_behind() noexcept;

 private:
  [[nodiscard]] static Result<Thread> begin(std::string name, std::function<void()> body, std::size_t stack_octets);
  pthread_t handle_{};
  bool joinable_{false};
};

/// Puts the calling thread under SCHED_FIFO; children made later start without it where the system can say so.
/// Priority 1..99, out of range refused; SystemFailure when the system does not permit it. Realtime: bounded.
[[nodiscard]] Result<> set_fifo_priority(int priority) noexcept;
/// The same under SCHED_RR: threads of one priority share the processor in turn, so that one that never rests leaves the others theirs.
[[nodiscard]] Result<> set_shared_priority(int priority) noexcept;
/// Returns the calling thread to ordinary scheduling.
[[nodiscard]] Result<> set_ordinary_scheduling() noexcept;
/// The same, for a thread that is in no hurry: it displaces nobody when it wakes, and hurry_end() leaves it so. What the system has no word
/// for is ordinary scheduling.
[[nodiscard]] Result<> set_background_scheduling() noexcept;
/// For a thread that may not have SCHED_FIFO: asks the ordinary scheduler for short slices, so that it is served sooner
/// after it wakes on a busy computer; needs no right. Unavailable where the system has no such wish (Linux from 6.12 on
/// heeds it, earlier ones accept and ignore it).
[[nodiscard]] Result<> ask_for_short_slices() noexcept;
/// Whether the calling thread may have SCHED_FIFO or SCHED_RR: tried and undone.
[[nodiscard]] bool realtime_permitted() noexcept;
/// Keeps the calling thread on one processor, counted from 0; Unavailable where the system has no such call.
[[nodiscard]] Result<> pin_to_cpu(unsigned cpu) noexcept;
/// Ties the calling thread to the last processor that it may use: the one that all cycles and devices of a node share
/// (docs/adr/0007). Unavailable where the system has no affinity.
[[nodiscard]] Result<> pin_to_cycle_cpu() noexcept;
/// How many processors the calling thread may use; 1 where the system cannot say.
[[nodiscard]] unsigned usable_processors() noexcept;
/// Names the calling thread (first 15 octets); for tools only, so a refusal is silent.
void set_thread_name(const char* name) noexcept;

/// Sleeps until the monotonic clock reads at least `wake`; signals do not shorten it. Realtime: blocks until then.
void sleep_until(TimePoint wake) noexcept;

/// Keeps all present and future pages of the process in memory, so that no cycle waits for a page fault.
[[nodiscard]] Result<> lock_memory() noexcept;

}  // namespace hirosco
