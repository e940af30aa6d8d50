// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "supervisor/guard/power.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/platform/launch/launcher.hpp"

/// What the guard holds of one member, and what it reads from it. Thread: under the guard's mutex.
namespace hirosco::supervisor {

inline constexpr Duration guard_period = std::chrono::milliseconds{5};
inline constexpr Duration guard_observation_period = std::chrono::milliseconds{10};
inline constexpr Duration permission_entry_limit = std::chrono::seconds{2};
/// Each step of the guard asks the second inhibit of a device, which answers at once. It takes no part in what moves: who is asked in
/// vain only says that a stop of this device would not be heard of, so there is time for a busy device.
inline constexpr Duration inhibit_silence = std::chrono::seconds{1};

/// What the guard saw or did, for the rest of the supervisor to tell and to plan for.
struct GuardFinding {
  enum class Kind : std::uint8_t {
    CycleHangs,  ///< its cycle stands still: fenced, its real-time priority taken; killed unless it comes back
    ServiceHangs,  ///< its service loop stands still: as above
    PageDamaged,  ///< its vital page is not one any more: as above
    Ended,  ///< the system says that its process has: fenced, with those that fall with it
    Starves,  ///< its loops kept the processor from a service loop: they lose their real-time priority, its cycle keeps its own
    Back,  ///< it moves again within the grace: it is not killed
    Killed,  ///< it did not come back
    SupervisorStill,  ///< the supervisor's own loop stood still: everything was fenced
    StopAsked,  ///< somebody stopped everything by signal or local socket
    InhibitSilent,  ///< it may act, and the second inhibit of one of its devices does not answer
    InhibitOfOtherVersion,  ///< as above, as it answers by frames of another version
    InhibitLost,  ///< it was let move, and an answer by the way in use is older than it may be: fenced
    InhibitFellBack,  ///< as above, and it goes on by the next way, or was let go by another than the preferred one
    PowerSilent,  ///< no word of a power switch is young enough: whether its device has power is not known
    PowerFellBack,  ///< the words of a power switch come by another way than before
  };
  Kind kind{};
  std::uint16_t apid{0};
  std::uint16_t device{0};  ///< of an inhibit, or a power switch: place in its descriptor
  friend bool operator==(const GuardFinding&, const GuardFinding&) = default;
};

/// One way to the second inhibit of a device (docs/adr/0237).
struct InhibitWay {
  std::unique_ptr<DataFlow> flow;
  KeptInhibit* note{nullptr};  ///< of what it was told last; null: nobody would go on telling it
  TimePoint heard_at{};
  std::optional<std::uint32_t> answered{};  ///< by it: the same again is no sign of life
};

/// A device of a member, by the endnode of its second inhibit. Enabled it is by one way, inhibited by all of them.
struct WatchedDevice {
  std::string name;
  std::uint16_t place{0};  ///< in the descriptor of its member
  std::vector<InhibitWay> ways;  ///< the preferred one, then its fall-backs
  std::size_t way{0};  ///< in use
  Duration silence{};  ///< oldest answer by it that counts; 0: there is no such limit
  Duration silence_reduced{};
  bool goes_on{false};  ///< by the next way, without a stop
  TimePoint taken_at{};  ///< when the way in use was
  bool falls_back{false};  ///< it was let go by another way than before: still to be told
  Duration stop_within{};
  descriptor::StopKind stop{};  ///< as its descriptor declares
  bool acts{false};  ///< it has said so since it was let go last, and has had power since
  std::uint32_t sequence{0};
  EnableStatus last{};
  bool heard{false};
  bool silence_told{false};
  bool other_version{false};  ///< of its newest answer: it counts as none
  std::uint32_t fenced_at_sequence{0};  ///< an answer to a later command knows of the newest stop
  std::optional<Duration> stopped;
  /// It has answered a command that came after the newest fence.
  [[nodiscard]] bool knows() const noexcept;
  /// It knows, and moves nothing.
  [[nodiscard]] bool rests() const noexcept;
  /// It acted and rests now, otherwise than its descriptor declares: in words; empty: it does as it is declared, or nobody knows.
  [[nodiscard]] std::string_view rests_otherwise() const noexcept;
  void hear(TimePoint now) noexcept;
  /// Once for each silence: it has not answered for `inhibit_silence`, counted from `since` at the earliest.
  [[nodiscard]] bool falls_silent(TimePoint since, TimePoint now) noexcept;
  /// The newest answer by the way in use, or its begin, or `since`, is older than `limit`; never without one.
  [[nodiscard]] bool unconfirmed(TimePoint since, Duration limit, TimePoint now) const noexcept;
  /// Takes the next way. False: there is none.
  bool fall_back(TimePoint now) noexcept;
  /// Before it is let go: by the first way that has answered within `limit`; where none has it is the preferred one.
  /// \return another one than before, and not the preferred one.
  bool choose_way(Duration limit, TimePoint now) noexcept;
  [[nodiscard]] GuardFinding::Kind why_silent() const noexcept {
    return other_version ? GuardFinding::Kind::InhibitOfOtherVersion : GuardFinding::Kind::InhibitSilent;
  }
  void tell(bool enabled, std::uint32_t epoch) noexcept;
  /// Nobody goes on enabling it, should this process end now.
  void withdraw_notes() noexcept;

 private:
  void hear_by(InhibitWay& by, bool in_use, TimePoint now) noexcept;
};

struct GuardedMember {
  /// What of its real-time priority this guard has taken; it has all of it back with its next release.
  enum class Taken : std::uint8_t { Nothing, Loops, All };

  const descriptor::MissionSubsystem* described{nullptr};
  bool spared{false};
  Mapping vital_memory, permit_memory;
  const VitalPage* vital{nullptr};
  PermitPage* permit{nullptr};
  std::shared_ptr<ProcessGrip> grip;
  std::vector<std::uint16_t> falls_with;  ///< whom its end stops, too
  std::uint32_t life{0};  ///< its life word while it is held
  bool life_told{false};  ///< it has ended, or what its word says is no life
  Taken taken{Taken::Nothing};
  bool guarded_before{false};  ///< by a guard that is gone and may have taken it as well
  bool page_on_its_way{false};  ///< it was adopted, and has not said yet that it looks at its new permit page
  std::uint32_t epoch{0};  ///< of the page, kept when a process ends
  std::uint64_t fences{0};
  std::uint32_t stopped_in{
      0};  ///< the newest stop of everything that fenced it, or may have before this guard or process
  bool fence_untold{false};  ///< the guard fenced it, and the supervisor is still to take what it found
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
  std::optional<TimePoint> asked_who_runs;  ///< since its service loop stands
  std::vector<LoopTime> had_then;  ///< by the loops of each member
  std::optional<TimePoint> doomed;  ///< killed then: in asked time where it may come back, else in watched time
  GuardFinding::Kind doom{};
  // stop
  TimePoint stop_begun{};  ///< of the newest that found it moving
  TimePoint stop_asked{};  ///< the same in the time in which its devices were asked
  std::optional<Duration> stopped;  ///< by its own word
  bool killed{false};
  std::uint64_t settled{0};  ///< the stop in which it had stopped and was let go again
  bool stop_killed{false};  ///< by the present stop: nobody is ended twice for one
  std::vector<WatchedDevice> devices;  ///< that can be asked
  std::vector<std::string> not_asked;  ///< its actuators without a second inhibit: it answers for them itself
  Duration rest_within{};  ///< the longest stop that one of its actuators declares, asked or not
  // power
  PowerSwitches power;
  std::optional<TimePoint> not_needed_since;  ///< its devices have power, and nobody wants it any more
  bool power_unknown{false};  ///< a guard that is gone may have told its switches to be on

  [[nodiscard]] std::uint16_t apid() const noexcept { return described->subsystem.id; }
  [[nodiscard]] std::optional<State> state() const noexcept;
  [[nodiscard]] bool damaged() const noexcept;
  /// Null: none, or its page is gone.
  [[nodiscard]] const descriptor::Configuration* in_force() const noexcept;
  /// Of its cycle, as declared; 0 while it has none.
  [[nodiscard]] Duration sampling() const noexcept;
  /// By its own word, while the guard has not taken it.
  [[nodiscard]] bool has_realtime() const noexcept;
  /// Of the answers of its second inhibit, the one that holds; 0: they have none.
  [[nodiscard]] Duration limit_of(const WatchedDevice& device) const noexcept;
  /// Whether its configuration in force uses this device of its descriptor.
  [[nodiscard]] bool uses(std::uint16_t device) const noexcept;
  /// In observations.
  [[nodiscard]] std::uint32_t hang_limit() const noexcept;

  [[nodiscard]] bool stands_fenced() const noexcept;
  /// By its own page, under the epoch that it has; empty: it acts.
  [[nodiscard]] std::string_view why_it_rests() const noexcept;
  void fence() noexcept;
  /// The same, by the guard of itself: nobody lets it go before the supervisor has heard of it.
  void fence_by_guard() noexcept {
    fence();
    fence_untold = true;
  }
  /// It has yet to stop: its time runs from now.
  void begin_stop(TimePoint now, TimePoint asked) noexcept;
  void release(TimePoint now) noexcept;
  /// A permission is for one stay in Operational: it ends with it.
  void end_permission(TimePoint now) noexcept;
  void take_realtime(Taken what) noexcept;

  /// Its devices have power from Hardware-Init to Hardware-Deinit, and then, or when its process is gone, until they rest, but no longer
  /// than their declared stop may take.
  void drive_power(TimePoint now) noexcept;
  /// Of a power switch that has fallen silent, or whose words come by another way, once each.
  [[nodiscard]] std::optional<GuardFinding> power_finding(TimePoint now) noexcept;
  [[nodiscard]] bool needs_power() const noexcept;
  [[nodiscard]] bool may_still_move(TimePoint now) noexcept;

  /// Those that can be asked say so, and for all others it does.
  [[nodiscard]] bool has_stopped() const noexcept;
  /// Its own word: that of its page.
  [[nodiscard]] bool says_stopped() const noexcept;
  /// A device that cannot be heard (unplugged, say) is no reason to end the subsystem that has let go of it.
  [[nodiscard]] bool to_blame() const noexcept;
  [[nodiscard]] Duration stop_limit() const noexcept;
};

}  // namespace hirosco::supervisor
