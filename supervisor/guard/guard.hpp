// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/utilities/os/mutex.hpp"
#include "supervisor/guard/guard_findings.hpp"
#include "supervisor/guard/guard_roster.hpp"
#include "supervisor/guard/guard_time.hpp"
#include "supervisor/guard/guarded_member.hpp"
#include "supervisor/guard/guarded_processes.hpp"
#include "supervisor/guard/inhibit_watch.hpp"
#include "supervisor/guard/loop_watch.hpp"
#include "supervisor/guard/stop_number.hpp"
#include "supervisor/guard/stop_of_all.hpp"
#include "supervisor/guard/supervisor_watch.hpp"
#include "supervisor/keeper/kept_endnodes.hpp"

/// What stops actuators, apart from everything else of the supervisor (docs/adr/0018): it holds every permit page and the
/// second inhibit and the power switch of every device that has one, watches that cycles and service loops move, takes the processor from one
/// that spins, and ends whoever does not come back. It needs no telemetry, queue, disk, mode or cycle, and it runs in a
/// thread of its own above all cycles; so it stops the craft although the rest of the supervisor stands still.
/// What else stops one, all ways with their files: docs/safety/stops.md.
namespace hirosco::supervisor {

/// Composes what the guard consists of under its one mutex, says in which order a step is made, and permits and fences each member.
class Guard {
 public:
  /// How often step() is to be called. Shorter than any enable limit by far.
  static constexpr Duration period = guard_period;
  /// How often cycles are counted.
  static constexpr Duration observation_period = guard_observation_period;
  /// A permission ends by itself unless Operational was reached in this time.
  static constexpr Duration entry_limit = permission_entry_limit;
  // Those of its parts.
  static constexpr Duration grace = LoopWatch::grace;
  static constexpr Duration service_limit = LoopWatch::service_limit;
  static constexpr Duration transient_service_limit = LoopWatch::transient_service_limit;
  static constexpr Duration supervisor_limit = SupervisorWatch::supervisor_limit;
  static constexpr Duration most_unwatched = GuardTime::most_unwatched;
  /// Of newest_stop().
  static constexpr std::uint32_t no_stop_yet = StopNumber::no_stop_yet;

  struct Parts {
    const Clock& clock;
    FlowFactory& flows;
    std::uint32_t first_epoch{1};  ///< of every permit page; higher than any that a device may have seen
    InhibitNotes notes{};  ///< what would go on being told to devices if this guard died
    std::function<void()> on_finding{};  ///< wakes the supervisor's loop. Thread: the guard's
  };
  explicit Guard(Parts parts);

  // --- the supervisor's loop ----------------------------------------------------------------------------------------
  /// One of the mission; opens the second inhibits and power switches of its devices. A spared one (the ground link) is fenced only with its
  /// network, never by stop_all(). Error: one of them cannot be opened.
  Result<> add(const descriptor::MissionSubsystem& described, bool spared);
  /// It was added: who was not is not to be started.
  [[nodiscard]] bool holds(std::uint16_t apid) const;
  /// It was started: its pages are taken over, nothing is permitted.
  void started(std::uint16_t apid, const LaunchedSubsystem& launched);
  /// It goes on after the guard that held it is gone (docs/adr/0093): under the same epoch, so that nothing that has stopped meanwhile
  /// can begin to move by this; and permitted only if it was, and is Operational, and nothing stands against it.
  /// \param against Why it may not go on; empty: it may.
  /// \return why it is not permitted; empty: it is.
  std::string_view adopt(std::uint16_t apid, const AdoptedSubsystem& adopted, std::string_view against);
  /// Whom this guard has adopted looks at its new permit page from now on: one that does not any more is one whose page is damaged.
  void looks_at_its_page(std::uint16_t apid);
  /// It was added, and its process had ended already under the guard before: its devices may be coming to rest still.
  void ended_before(std::uint16_t apid);
  /// It is permitted, and a device of it says that it does not put out what it is told: it stopped while nobody told it that it may.
  [[nodiscard]] bool has_stopped_by_itself(std::uint16_t apid) const;
  /// It has ended: its devices stay inhibited.
  void forget(std::uint16_t apid);
  /// Who is fenced with it at once when its process ends, in the guard's own thread; the newest word counts.
  void falls_with(std::uint16_t apid, std::vector<std::uint16_t> others);
  void beat() noexcept { supervisor_watch_.beat(); }
  [[nodiscard]] std::vector<GuardFinding> take_findings();

  // --- any thread ---------------------------------------------------------------------------------------------------
  /// Number of the newest stop of everything, as it stands on all permit pages: what was said under another one lets nobody move.
  [[nodiscard]] std::uint32_t newest_stop() const noexcept { return stop_number_.newest(); }
  /// It was stopped with everything since that number: what was said for it then was said in another situation.
  [[nodiscard]] bool was_stopped_since(std::uint16_t apid, std::uint32_t number) const;
  /// As if everything had been stopped again: what nobody has read yet, or has been said before, lets nobody move.
  void void_what_was_said();
  /// Actuators inhibited: on its permit page at once, which its next cycle reads, and at the devices that have a second inhibit
  /// within two steps of this guard. A device without one has its own watchdog for a cycle that does not read any more.
  /// \return its fences(), this one counted.
  std::uint64_t fence(std::uint16_t apid);
  /// How often it was fenced: what was permitted before must not lift a later fence.
  [[nodiscard]] std::uint64_t fences(std::uint16_t apid) const;
  [[nodiscard]] bool fenced(std::uint16_t apid) const;
  /// Lets its actuators move once it is Operational. False, and nothing is done: it was fenced since `seen_fences`.
  [[nodiscard]] bool release(std::uint16_t apid, std::uint64_t seen_fences);
  /// Everything that moves is stopped, but for the spared.
  /// \return names this stop; stop_outcome() is asked with it.
  std::uint64_t stop_all(GuardFinding::Kind why);
  std::uint64_t stop_all();
  /// The answers, once all have stopped or their time has run out; empty while some have not.
  [[nodiscard]] std::optional<std::vector<StopAnswer>> stop_outcome(std::uint64_t stop) const;
  /// Highest epoch of all pages, for who must remember it.
  [[nodiscard]] std::uint32_t highest_epoch() const;

  // --- the thread that waits for ends ---------------------------------------------------------------------------------
  using WatchedLife = GuardedProcesses::WatchedLife;
  /// Changes with whom lives() names, and who waits on it is woken.
  [[nodiscard]] const std::atomic<std::uint32_t>& changes() const noexcept { return processes_.changes(); }
  [[nodiscard]] std::vector<WatchedLife> lives() const;
  /// Its word has changed. When it says that the process has ended, or what none that lives says, the member is fenced with those that fall with
  /// it; from then on lives() leaves it out, so that no word can keep a thread busy.
  void life_changed(std::uint16_t apid);

  // --- the guard's thread -------------------------------------------------------------------------------------------
  /// Returns when it is due again.  Realtime: bounded; no heap but for findings.
  TimePoint step(TimePoint now);

 private:
  const Clock& clock_;
  mutable Mutex mutex_;
  GuardRoster guarded_;
  GuardFindings findings_;
  GuardTime time_{guarded_};
  StopNumber stop_number_{guarded_};
  StopOfAll stop_of_all_;
  SupervisorWatch supervisor_watch_;
  LoopWatch loop_watch_;
  InhibitWatch inhibit_watch_;
  GuardedProcesses processes_;
};

}  // namespace hirosco::supervisor
