// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// One thread as others of its process reach it: what can be done to it whatever it does itself. A thread cannot be ended from outside;
/// its priority can be taken, and what it had of the processor can be asked. While nobody has entered nothing happens.
/// Realtime: bounded, system calls, no heap. Thread: enter() and leave() are the held one's, the rest is for any.
class ThreadHold {
 public:
  /// From now on the calling thread is the one that is held; it leaves before it ends.
  void enter() noexcept;
  void leave() noexcept;

  /// It has ordinary scheduling from now on. False: the system refused it.
  bool take_realtime() noexcept;
  /// What was taken is given back, unless it has given itself a priority since.
  void give_realtime() noexcept;
  [[nodiscard]] bool has_realtime() noexcept;
  /// Processor time that it has had; that of one which has left stays as it was then.
  [[nodiscard]] Duration processor_time() noexcept;

 private:
  struct Scheduling {
    int policy{0};
    int priority{0};
  };
  // Of the backend; under the mutex, while it is present.
  void remember() noexcept;
  [[nodiscard]] Scheduling scheduling() const noexcept;
  [[nodiscard]] bool schedule(const Scheduling& as) const noexcept;
  [[nodiscard]] Duration had() const noexcept;

  Mutex mutex_;
  bool present_{false};
  pthread_t handle_{};
  [[maybe_unused]] int number_{0};  ///< of the system, where it has one
  Scheduling taken_{};  ///< priority 0: nothing
  Duration had_before_{};
};

}  // namespace hirosco
