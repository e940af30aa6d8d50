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
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/subsystem/pages.hpp"
#include "hirosco/subsystem/states.hpp"
#include "hirosco/utilities/os/mutex.hpp"
#include "supervisor/platform/launcher.hpp"

/// What stops actuators, apart from everything else of the supervisor (docs/adr/0018): it holds every permit page and the
/// second inhibit of every device that has one, watches that cycles and service loops move, takes the processor from one
/// that spins, and ends whoever does not come back. It needs no telemetry, queue, disk, mode or cycle, and it runs in a
/// thread of its own above all cycles; so it stops the craft although the rest of the supervisor stands still.
namespace hirosco::supervisor {

/// What the guard saw or did, for the rest of the supervisor to tell and to plan for.
struct GuardFinding {
  enum class Kind : std::uint8_t {
    CycleHangs,  ///< its cycle stands still: fenced, its real-time priority taken; killed unless it comes back
    ServiceHangs,  ///< its service loop stands still: as above
    PageDamaged,  ///< its vital page is not one any more: as above
    Back,  ///< it moves again within the grace: it is not killed
    Killed,  ///< it did not come back
    SupervisorStill,  ///< the supervisor's own loop stood still: everything was fenced
    StopAsked,  ///< somebody stopped everything by signal or local socket
  };
  Kind kind{};
  std::uint16_t apid{0};
};

/// How one actuator, or a member without one that can be asked, answered the stop of everything.
struct StopAnswer {
  std::uint16_t apid{0};
  std::string name;  ///< of the device, or of the member where no device of its can be asked
  bool asked_device{false};  ///< the device said it, on the endnode of its second inhibit
  std::optional<Duration> stopped;  ///< after the stop was ordered; empty: it did not
  bool killed{false};  ///< its member was ended, as it had not stopped in time
};

class Guard {
 public:
  /// How often step() is to be called. Shorter than any enable limit by far.
  static constexpr Duration period = std::chrono::milliseconds{5};
  /// How often cycles are counted.
  static constexpr Duration observation_period = std::chrono::milliseconds{10};
  /// What a member may take to come back after it was found to hang.
  static constexpr Duration grace = std::chrono::seconds{1};
  /// A service loop may be busy in the author's code for this long; in a transient state as long as that may last.
  static constexpr Duration service_limit = std::chrono::seconds{3};
  static constexpr Duration transient_service_limit = std::chrono::seconds{12};
  /// The supervisor's own loop steps every 10 ms.
  static constexpr Duration supervisor_limit = std::chrono::seconds{1};
  /// A permission ends by itself unless Operational was reached in this time.
  static constexpr Duration entry_limit = std::chrono::seconds{2};

  struct Parts {
    const Clock& clock;
    FlowFactory& flows;
    std::uint32_t first_epoch{1};  ///< of every permit page; higher than any that a device may have seen
    std::function<void()> on_finding{};  ///< wakes the supervisor's loop. Thread: the guard's
  };
  explicit Guard(Parts parts) : parts_{std::move(parts)} {}

  // --- the supervisor's loop ----------------------------------------------------------------------------------------
  /// One of the mission; opens the second inhibits of its devices. A spared one (the ground link) is fenced only with its
  /// network, never by stop_all(). Error: a device's enable endnode cannot be opened.
  Result<> add(const descriptor::MissionSubsystem& described, bool spared);
  /// It was started: its pages are taken over, nothing is permitted.
  void adopt(std::uint16_t apid, const LaunchedSubsystem& launched);
  /// It has ended: its devices stay inhibited.
  void forget(std::uint16_t apid);
  void beat() noexcept { beats_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] std::vector<GuardFinding> take_findings();

  // --- any thread ---------------------------------------------------------------------------------------------------
  /// Actuators inhibited at its next cycle, and at its devices.
  void fence(std::uint16_t apid);
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

  // --- the guard's thread -------------------------------------------------------------------------------------------
  /// Returns when it is due again.  Realtime: bounded; no heap but for findings.
  TimePoint step(TimePoint now);

 private:
  struct Device {
    std::string name;
    std::unique_ptr<DataFlow> flow;
    Duration stop_within{};
    std::uint32_t sequence{0};
    EnableStatus last{};
    bool heard{false};
    std::uint32_t fenced_at_sequence{0};  ///< an answer to a later command knows of the newest stop
    std::optional<Duration> stopped;
  };
  struct Watched {
    const descriptor::MissionSubsystem* described{nullptr};
    bool spared{false};
    Mapping vital_memory, permit_memory;
    const VitalPage* vital{nullptr};
    PermitPage* permit{nullptr};
    std::shared_ptr<ProcessGrip> grip;
    std::uint32_t epoch{0};  ///< of the page, kept when a process ends
    std::uint64_t fences{0};
    // permission
    bool released{false};
    bool seen_operational{false};
    TimePoint released_at{};
    // observation
    std::uint64_t cycles{0};
    std::uint32_t still{0};
    Duration processor_time{};  ///< when the cycle stood still first
    std::uint64_t service_steps{0};
    TimePoint service_moved{};
    std::optional<TimePoint> doomed;  ///< killed then unless it comes back
    GuardFinding::Kind doom{};
    // stop
    std::optional<Duration> stopped;
    bool killed{false};
    std::uint64_t settled{0};  ///< the stop in which it had stopped and was let go again
    bool stop_killed{false};  ///< by the present stop: nobody is ended twice for one
    std::vector<Device> devices;
    [[nodiscard]] std::uint16_t apid() const noexcept { return described->subsystem.id; }
    [[nodiscard]] std::optional<State> state() const noexcept;
    [[nodiscard]] bool damaged() const noexcept;
    [[nodiscard]] bool stands_fenced() const noexcept;
    [[nodiscard]] Duration slow_steps() const noexcept;
    [[nodiscard]] std::uint32_t hang_limit() const noexcept;
  };
  [[nodiscard]] Watched* find(std::uint16_t apid) noexcept;
  [[nodiscard]] const Watched* find(std::uint16_t apid) const noexcept;
  void fence(Watched& member) noexcept;
  void find_out(GuardFinding::Kind kind, std::uint16_t apid);
  void watch_supervisor(TimePoint now);
  void observe(TimePoint now);
  void observe_cycle(Watched& member, TimePoint now);
  void observe_service(Watched& member, TimePoint now);
  [[nodiscard]] Watched& spinner(Watched& standing);
  void doom(Watched& member, GuardFinding::Kind why, TimePoint now);
  void judge_doomed(Watched& member, TimePoint now);
  void end_permission(Watched& member, TimePoint now) noexcept;
  void tell_devices(Watched& member, TimePoint now) noexcept;
  void follow_stop(TimePoint now);
  [[nodiscard]] bool has_stopped(const Watched& member) const noexcept;
  [[nodiscard]] bool says_stopped(const Watched& member) const noexcept;
  [[nodiscard]] bool to_blame(const Watched& member) const noexcept;
  [[nodiscard]] Duration stop_limit(const Watched& member) const noexcept;

  Parts parts_;
  mutable Mutex mutex_;
  std::vector<Watched> members_;
  std::vector<GuardFinding> findings_;
  std::atomic<std::uint64_t> beats_{0};
  std::uint64_t seen_beats_{0};
  std::optional<TimePoint> beat_seen_;
  bool supervisor_still_{false};
  TimePoint next_observation_{};
  std::uint64_t stops_{0};  ///< the newest stop of everything
  std::uint64_t stops_ended_{0};
  TimePoint stop_begun_{};
};

}  // namespace hirosco::supervisor
