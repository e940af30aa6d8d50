// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "simulation/spacecraft/last_moment.hpp"
#include "simulation/spacecraft/simulated_keeper.hpp"
#include "simulation/spacecraft/simulated_processes.hpp"
#include "simulation/spacecraft/supervisor_stores.hpp"
#include "supervisor/supervisor.hpp"

namespace hirosco::simulation {

/// The supervisor with its guard on virtual time; it dies, and another one goes on with what runs (docs/adr/0093).
class SimulatedSupervisor {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    Platform platform;
    supervisor::Observer& observer;
    SimulatedProcesses& processes;
    SimulatedKeeper& keeper;
    SupervisorStores& stores;
    std::uint64_t seed;  ///< of its sequence counts
  };
  /// Makes the first one.
  explicit SimulatedSupervisor(Parts parts);
  SimulatedSupervisor(const SimulatedSupervisor&) = delete;
  SimulatedSupervisor& operator=(const SimulatedSupervisor&) = delete;
  /// Starts the subsystems of the mission.
  void start() { supervisor_->start(); }

  /// Not to be asked while there is none.
  [[nodiscard]] supervisor::Supervisor& supervisor() noexcept { return *supervisor_; }
  [[nodiscard]] supervisor::Guard& guard() noexcept { return *guard_; }
  [[nodiscard]] bool finished() const noexcept { return supervisor_ && supervisor_->finished(); }
  /// There is one, and it does not hang.
  [[nodiscard]] bool supervises() const noexcept {
    return supervisor_ && !stands_still_ && clock_.now() >= hangs_until_;
  }

  /// When supervisor, guard or what stands in for them is due.
  [[nodiscard]] TimePoint next_wake() const noexcept;
  /// What is due: the keeper ends one that hangs, the next one goes on, guard or keeper, supervisor.
  void step(TimePoint now);
  /// Its process stands still, as by SIGSTOP, and goes on. Nothing, where there is none.
  void stop(bool stopped);
  /// Its loop makes no step for that long, beside its guard, as one that spins in a step. The keeper ends it when its patience is over.
  void hang(Duration span);

  /// It ends without a word, as by kill -9, between two of its steps.  \param pause Until the next one, where there is one.
  void kill(std::optional<Duration> pause = {});
  /// Nobody goes on for it.
  void keep_down() noexcept { revive_at_.reset(); }
  /// Those that have died.
  [[nodiscard]] int deaths() const noexcept { return deaths_; }
  /// Called as a step of the supervisor begins, and behind its end.
  enum class Moment : std::uint8_t { Begins, Ends };
  void on_step(std::function<void(Moment)> watch) { on_step_ = std::move(watch); }
  /// It ends at this very moment, in the middle of its step: of what it does from here on until that returns nothing reaches pages
  /// or the journal.
  void die_here();
  /// In the middle of its step, as long as this is so: what is due beside it goes on.
  void stand_still(bool still) noexcept { stands_still_ = still; }
  [[nodiscard]] bool is_dying() const noexcept { return last_moment_ != nullptr; }
  /// `hirosco safe`: the guard stops everything at once, or the next one where there is none now; the supervisor hears of it in its next
  /// step.
  void stop_beside_flight();

 private:
  static constexpr TimePoint never = TimePoint::max();

  void make(std::uint32_t first_epoch);
  void revive(TimePoint now);
  void step_supervisor(TimePoint now);
  [[nodiscard]] TimePoint supervisor_due() const noexcept {
    return stands_still_ ? never : std::max(supervisor_wake_, hangs_until_);
  }
  /// When the keeper ends it, as it hangs; `never`: it does not, or not as long.
  [[nodiscard]] TimePoint ended_at() const noexcept;

  Parts parts_;
  const Clock& clock_{parts_.platform.clock};
  std::optional<TimePoint> revive_at_;  ///< there is no supervisor now
  std::uint32_t next_first_epoch_{1};
  std::unique_ptr<LastMoment> last_moment_;  ///< of one that dies in the middle of its step; null: none does
  bool stands_still_{false};  ///< in the middle of its step
  int deaths_{0};
  std::function<void(Moment)> on_step_;
  std::optional<supervisor::Guard> guard_;
  std::unique_ptr<supervisor::Supervisor> supervisor_;
  TimePoint supervisor_wake_{};
  TimePoint guard_wake_{};
  TimePoint hangs_until_{};
  TimePoint patience_over_{};  ///< the keeper's, with one that hangs as long
};

}  // namespace hirosco::simulation
