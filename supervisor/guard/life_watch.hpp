// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/guard/guard.hpp"

namespace hirosco::supervisor {

/// A thread of the guard's that sleeps until a member's process ends, and has it fenced with its network before the system has given its memory
/// back (docs/adr/0102). The process handle says the same later, by a time that grows with the process; all else waits for that.
class LifeWatch {
 public:
  /// Beside the guard: whoever ends stops nobody's cycle but his own.
  static constexpr int priority = 90;
  /// Of more members than this the process handles alone tell.
  static constexpr std::size_t most = 127;
  /// Unavailable: the system cannot wait on several words.
  [[nodiscard]] static Result<std::unique_ptr<LifeWatch>> start(Guard& guard);
  ~LifeWatch();
  LifeWatch(const LifeWatch&) = delete;
  LifeWatch& operator=(const LifeWatch&) = delete;

 private:
  explicit LifeWatch(Guard& guard) : guard_{guard} {}
  void run();

  Guard& guard_;
  std::atomic<bool> ended_{false};
  Thread thread_;
};

}  // namespace hirosco::supervisor
