// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <utility>

#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// What steps wait for that nobody reports: looked at in every watch period.  Thread: the supervisor's.
class Waiting final : public Watch {
 public:
  static constexpr std::size_t most = 256;

  /// `done` is called once: true as soon as `holds`, now perhaps; false at the deadline, or where too many wait.
  void wait(TimePoint now, TimePoint deadline, std::function<bool()> holds, CommandDone done) {
    if (holds()) return done(true, {});
    if (now >= deadline || count_ == most) return done(false, count_ == most ? "too many wait" : too_late);
    ++count_;
    waits_.push_back({deadline, std::move(holds), std::move(done)});
  }
  void watch(TimePoint now) override {
    // Whoever is told may wait for something else: that is looked at in the next period.
    for (std::list<Wait> looked_at = std::exchange(waits_, {}); !looked_at.empty();) {
      std::list<Wait> one;
      one.splice(one.begin(), looked_at, looked_at.begin());
      const Wait& wait = one.front();
      const bool holds = wait.holds();
      if (!holds && now < wait.deadline) {
        waits_.splice(waits_.end(), one);
        continue;
      }
      --count_;
      wait.done(holds, holds ? "" : too_late);
    }
  }

 private:
  static constexpr const char* too_late = "not in its time";
  struct Wait {
    TimePoint deadline{};
    std::function<bool()> holds;
    CommandDone done;
  };
  std::list<Wait> waits_;
  std::size_t count_{0};  ///< with those that are being looked at
};

}  // namespace hirosco::supervisor
