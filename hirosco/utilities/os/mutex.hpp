// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include "hirosco/utilities/os/thread_annotations.hpp"

namespace hirosco {

/// Mutual exclusion with priority inheritance: who holds it runs at the priority of the most urgent waiter.
/// Realtime: lock() blocks as long as the holder holds it, try_lock() and unlock() are bounded. Thread: any; the one
/// that locked unlocks. Not recursive.
class HIROSCO_CAPABILITY("mutex") Mutex {
 public:
  Mutex() noexcept;
  ~Mutex();
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;

  void lock() noexcept HIROSCO_ACQUIRE();
  [[nodiscard]] bool try_lock() noexcept HIROSCO_TRY_ACQUIRE(true);
  void unlock() noexcept HIROSCO_RELEASE();
  /// The operating system granted the inheritance protocol.
  [[nodiscard]] bool inherits_priority() const noexcept { return inherits_priority_; }

 private:
  pthread_mutex_t mutex_;
  bool inherits_priority_{false};
};

/// Holds a mutex for a scope.
class HIROSCO_SCOPED_CAPABILITY LockGuard {
 public:
  explicit LockGuard(Mutex& mutex) noexcept HIROSCO_ACQUIRE(mutex) : mutex_{mutex} { mutex_.lock(); }
  ~LockGuard() HIROSCO_RELEASE() { mutex_.unlock(); }
  LockGuard(const LockGuard&) = delete;
  LockGuard& operator=(const LockGuard&) = delete;

 private:
  Mutex& mutex_;
};

}  // namespace hirosco
