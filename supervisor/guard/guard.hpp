// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/os/mutex.hpp"
#include "supervisor/guard/guarded_member.hpp"
#include "supervisor/keeper/kept_endnodes.hpp"

/// What stops actuators, apart from everything else of the supervisor (docs/adr/0018): it holds every permit page and the
/// second inhibit and the power switch of every device that has one, watches that cycles and service loops move, takes the processor from one
/// that spins, and ends whoever does not come back. It needs no telemetry, queue, disk, mode or cycle, and it runs in a
/// thread of its own above all cycles; so it stops the craft although the rest of the supervisor stands still.
/// What else stops one, all ways with their files: docs/safety/stops.md.
namespace hirosco::supervisor {

/// How one actuator, or a member without any, answered the stop of everything.
struct StopAnswer {
  std::uint16_t apid{0};
  std::string name;  ///< of the device, or of the member where it has no actuator
  bool asked_device{false};  ///< the device said it, on the endnode of its second inhibit; else its member did
  std::optional<Duration> stopped;  ///< after the stop was ordered; empty: it did not
  bool killed{false};  ///< its member was ended, as it had not stopped in time
};

class Guard {
 public:
  /// How often step() is to be called. Shorter than any enable limit by far.
  static constexpr Duration period = std::chrono::milliseconds{5};
  /// How often cycles are counted.
  static constexpr Duration observation_period = guard_observation_period;
  /// What a member may take to come back after it was found to hang.
  static constexpr Duration grace = std::chrono::seconds{1};
  /// A service loop may be busy in the author's code for this long; in a transient state as long as that may last.
  static constexpr Duration service_limit = std::chrono::seconds{3};
  static constexpr Duration transient_service_limit = std::chrono::seconds{12};
  /// The supervisor's own loop steps every 10 ms.
  static constexpr Duration supervisor_limit = std::chrono::seconds{1};
  /// A permission ends by itself unless Operational was reached in this time.
  static constexpr Duration entry_limit = permission_entry_limit;
  /// Of newest_stop().
  static constexpr std::uint32_t no_stop_yet = 1;
  /// What may pass between two steps and count; see `watched_at`.
  static constexpr Duration most_unwatched = 4 * period;

  struct Parts {
    const Clock& clock;
    FlowFactory& flows;
    std::uint32_t first_epoch{1};  ///< of every permit page; higher than any that a device may have seen
    InhibitNotes notes{};  ///< what would go on being told to devices if this guard died
    std::function<void()> on_finding{};  ///< wakes the supervisor's loop. Thread: the guard's
  };
  explicit Guard(Parts parts) : parts_{std::move(parts)} {}

  // --- the supervisor's loop ----------------------------------------------------------------------------------------
  /// One of the mission; opens the second inhibits and power switches of its devices. A spared one (the ground link) is fenced only with its
  /// network, never by stop_all(). Error: one of them cannot be opened.
  Result<> add(const descriptor::MissionSubsystem& described, bool spared);
  /// It was added: who was not is not to be started.
  [[nodiscard]] bool holds(std::uint16_t apid) const;
  /// It was started: its pages are taken over, nothing is permitted.
  void adopt(std::uint16_t apid, const LaunchedSubsystem& launched);
  /// It goes on after the guard that held it is gone (docs/adr/0093): under the same epoch, so that nothing that has stopped meanwhile
  /// can begin to move by this; and permitted only if it was, and is Operational, and nothing stands against it.
  /// \param against Why it may not go on; empty: it may.
  /// \return why it is not permitted; empty: it is.
  std::string_view take_over(std::uint16_t apid, const AdoptedSubsystem& adopted, std::string_view against);
  /// It was added, and its process had ended already under the guard before: its devices may be coming to rest still.
  void ended_before(std::uint16_t apid);
  /// It is permitted, and a device of it says that it does not put out what it is told: it stopped while nobody told it that it may.
  [[nodiscard]] bool has_stopped_by_itself(std::uint16_t apid) const;
  /// It has ended: its devices stay inhibited.
  void forget(std::uint16_t apid);
  /// Who is fenced with it at once when its process ends, in the guard's own thread; the newest word counts.
  void falls_with(std::uint16_t apid, std::vector<std::uint16_t> others);
  void beat() noexcept { beats_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] std::vector<GuardFinding> take_findings();

  // --- any thread ---------------------------------------------------------------------------------------------------
  /// Number of the newest stop of everything, as it stands on all permit pages: what was said under another one lets nobody move.
  [[nodiscard]] std::uint32_t newest_stop() const noexcept { return newest_stop_.load(std::memory_order_acquire); }
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
  /// A member whose process may end, by the word that the system marks then.
  struct WatchedLife {
    std::uint16_t apid{0};
    Mapping memory;  ///< keeps the word
    const std::atomic<std::uint32_t>* word{nullptr};
    std::uint32_t seen{0};
  };
  /// Changes with whom lives() names, and who waits on it is woken.
  [[nodiscard]] const std::atomic<std::uint32_t>& changes() const noexcept { return changes_; }
  [[nodiscard]] std::vector<WatchedLife> lives() const;
  /// Its word has changed. When it says that the process has ended, or what none that lives says, the member is fenced with those that fall with
  /// it; from then on lives() leaves it out, so that no word can keep a thread busy.
  void life_changed(std::uint16_t apid);

  // --- the guard's thread -------------------------------------------------------------------------------------------
  /// Returns when it is due again.  Realtime: bounded; no heap but for findings.
  TimePoint step(TimePoint now);

 private:
  [[nodiscard]] GuardedMember* find(std::uint16_t apid) noexcept;
  [[nodiscard]] const GuardedMember* find(std::uint16_t apid) const noexcept;
  void find_out(GuardFinding::Kind kind, std::uint16_t apid, std::uint16_t device = 0);
  void lives_changed() noexcept;
  void put_newest_stop(std::uint32_t number) noexcept;
  void next_stop() noexcept;
  std::uint64_t begin_stop_of_all();
  /// The time by which somebody is found to stand still: what the guard has watched. While nobody ran (the host was stopped) nobody can be blamed for
  /// standing still, so of a longer time between two steps little counts, unless some cycle went on meanwhile.
  [[nodiscard]] TimePoint watched_at(TimePoint now) const noexcept;
  /// The time by which somebody is ended: that in which the guard asked and could hear. Of a longer time between two of its own steps little
  /// counts, whoever went on: what was done meanwhile, nobody could tell it.
  [[nodiscard]] TimePoint asked_at(TimePoint now) const noexcept;
  [[nodiscard]] bool somebody_went_on(Duration passed) const noexcept;
  void watch_supervisor(TimePoint now);
  void observe(TimePoint now);
  void observe_cycle(GuardedMember& member, TimePoint now);
  void observe_service(GuardedMember& member, TimePoint now);
  [[nodiscard]] GuardedMember& spinner(GuardedMember& standing);
  void look_who_runs(GuardedMember& standing, TimePoint now) noexcept;
  [[nodiscard]] bool was_starved(GuardedMember& standing, TimePoint now);
  void doom(GuardedMember& member, GuardFinding::Kind why, TimePoint now);
  void judge_doomed(GuardedMember& member, TimePoint now);
  void follow_stop(TimePoint now);

  Parts parts_;
  mutable Mutex mutex_;
  std::vector<GuardedMember> members_;
  std::vector<GuardFinding> findings_;
  std::atomic<std::uint32_t> changes_{0};
  std::atomic<std::uint64_t> beats_{0};
  std::uint64_t seen_beats_{0};
  std::optional<TimePoint> beat_seen_;
  bool supervisor_still_{false};
  std::optional<TimePoint> stepped_;  ///< last, and what had been watched and asked by then
  TimePoint watched_{}, asked_{};
  TimePoint next_observation_{};
  std::atomic<std::uint32_t> newest_stop_{no_stop_yet};
  std::uint64_t stops_{0};  ///< the newest stop of everything whose outcome may be asked for
  std::uint64_t stops_ended_{0};
};

}  // namespace hirosco::supervisor
