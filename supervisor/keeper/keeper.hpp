// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/time.hpp"

/// The small process at the top (decision 1): starts the simulated devices and the supervisor, hands signals down, ends
/// what is left. Parses nothing from outside.
namespace hirosco::supervisor {

/// The supervisor finds the reading end of a pipe here; it is closed when the keeper is gone.
inline constexpr int keeper_descriptor = 6;

/// Memory in which keeper and supervisor see each other move: one that is alive and stands still is as lost as one that
/// has died (hazard SF18). The supervisor finds it here.
inline constexpr int keeper_page_descriptor = 7;
struct KeeperPage {
  std::atomic<std::uint64_t> keeper{0};
  std::atomic<std::uint64_t> supervisor{0};
};
/// How long either may stand still once it has moved.
inline constexpr Duration keeper_patience = std::chrono::seconds{3};

/// Looks at one counter of the page from time to time.
class Progress {
 public:
  /// Of the time between two looks no more counts: while the whole computer was stopped neither could move.
  static constexpr Duration most_unwatched = std::chrono::milliseconds{400};
  /// True while it has moved and then stood still for longer than the patience. A counter that is damaged has moved once.
  [[nodiscard]] bool stands_still(std::uint64_t count, TimePoint now) noexcept {
    if (looked_) still_ += std::min(now - *looked_, most_unwatched);
    looked_ = now;
    if (count != seen_) {
      seen_ = count;
      begun_ = true;
      still_ = Duration{0};
    }
    return begun_ && still_ > keeper_patience;
  }

 private:
  std::uint64_t seen_{0};
  bool begun_{false};
  Duration still_{};
  std::optional<TimePoint> looked_;
};

struct KeeperPlan {
  ProcessStart supervisor;
  std::vector<ProcessStart> devices;
  std::optional<Duration> run_for;  ///< end in order after this time
};

/// Returns the exit code of the supervisor, 4 when it was ended by a signal or stood still. SIGUSR1 stops everything that
/// moves. Blocks until everything has ended, the subsystems of a supervisor that died before them included.
[[nodiscard]] int keep(KeeperPlan plan);

}  // namespace hirosco::supervisor
