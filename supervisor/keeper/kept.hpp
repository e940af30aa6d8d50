// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/utilities/time.hpp"

/// What the keeper holds so that it outlives the supervisor, and where a supervisor finds it (docs/adr/0093).
namespace hirosco::supervisor {

/// The supervisor finds the reading end of a pipe here; it is closed when the keeper is gone.
inline constexpr int keeper_descriptor = 6;
/// KeeperPage.
inline constexpr int keeper_page_descriptor = 7;
/// Socket on which the supervisor hands over what is to be kept.
inline constexpr int keeper_store_descriptor = 8;
/// Memory of the journal (supervision/succession/journal.hpp), of `journal_octets`.
inline constexpr int keeper_journal_descriptor = 9;
/// Memory of the texts by which the mission flies (supervision/succession/texts_in_force.hpp), of `texts_octets`.
inline constexpr int keeper_texts_descriptor = 10;
/// The writing end of a pipe that the keeper has, too, and whose reading end is the standard input of all that it started beside the supervisor:
/// those end when both are gone, and not before (docs/adr/0217).
inline constexpr int flight_held_descriptor = 15;
/// From here on, what the supervisor before had handed over: slot by slot, a descriptor for each role.
inline constexpr int first_kept_descriptor = 16;

/// What is kept of one subsystem; its slot is its place in the mission.
enum class KeptRole : std::uint8_t { Channel, Vital, Permit, Process, Errors };
inline constexpr std::size_t kept_roles = 5;
inline constexpr std::size_t most_kept = 96;
[[nodiscard]] constexpr int kept_descriptor(std::size_t slot, KeptRole role) noexcept {
  return first_kept_descriptor + static_cast<int>(slot * kept_roles) + static_cast<int>(role);
}

inline constexpr std::size_t journal_octets = std::size_t{2} << 20;
/// Twice as many as texts take, held from the begin: who writes there is never refused memory.
inline constexpr std::size_t texts_octets = std::size_t{8} << 20;

/// The second inhibit of one device as the guard told it last: the keeper goes on telling it while there is no guard.
/// Damage enables nothing: it has to be the permission word of its epoch.
struct KeptInhibit {
  std::atomic<std::uint32_t> epoch{0};
  std::atomic<std::uint32_t> sequence{0};  ///< of the newest command
  std::atomic<std::uint64_t> go{0};  ///< permission_word(epoch): enabled
  /// 1: another way to the same inhibit is what enables it, and this one is told nothing meanwhile (docs/adr/0237).
  std::atomic<std::uint32_t> untold{0};

  /// Realtime: wait-free.
  void note(bool enabled, std::uint32_t of_epoch, std::uint32_t of_sequence) noexcept {
    untold.store(0, std::memory_order_release);
    const std::uint64_t word = enabled ? permission_word(of_epoch) : 0;
    if (go.load(std::memory_order_relaxed) != word) go.store(0, std::memory_order_release);
    epoch.store(of_epoch, std::memory_order_release);
    sequence.store(of_sequence, std::memory_order_release);
    go.store(word, std::memory_order_release);
  }
  void note_untold(std::uint32_t of_epoch, std::uint32_t of_sequence) noexcept {
    note(false, of_epoch, of_sequence);
    untold.store(1, std::memory_order_release);
  }
  /// From now on whoever goes on telling it inhibits by it.
  void withdraw() noexcept {
    go.store(0, std::memory_order_release);
    untold.store(0, std::memory_order_release);
  }
  [[nodiscard]] bool enabled() const noexcept {
    return go.load(std::memory_order_acquire) == permission_word(epoch.load(std::memory_order_acquire));
  }
};
inline constexpr std::size_t most_inhibits = 64;

/// How a process ended whose parent, a supervisor, was gone: the keeper is told, as nobody else is.
struct KeptEnd {
  std::atomic<std::uint32_t> pid{0};
  std::atomic<std::uint32_t> how{0};  ///< exit code, or 0x100 and the signal
};
inline constexpr std::uint32_t ended_by_signal = 0x100;
inline constexpr std::size_t most_ends = 64;

/// Memory in which keeper and supervisor see each other move: one that is alive and stands still is as lost as one that
/// has died (hazard SF18).
struct KeeperPage {
  /// Of this layout. Keeper and supervisor of one flight are of one build; whoever finds another number knows nothing of what is there, not
  /// even whether a craft flies already.
  static constexpr std::uint64_t layout_now = 0x484B'5047'0000'0007;  // "HKPG"
  std::atomic<std::uint64_t> layout{layout_now};
  std::atomic<std::uint64_t> keeper{0};
  std::atomic<std::uint64_t> supervisor{0};
  std::atomic<std::uint32_t> finished{0};  ///< 1: the supervisor ends by itself, and the flight with it
  std::atomic<std::uint32_t> commissioned{0};  ///< 1: the start mode is reached, for once
  std::atomic<std::uint32_t> alone{
      0};  ///< 1: nothing that the supervisor has started outlives it, so nobody goes on for it
  std::atomic<std::uint32_t> starts{0};  ///< supervisors that were started
  std::atomic<std::uint32_t> guard_life{0};  ///< a life word (os/life.hpp), held by the thread of the guard
  std::atomic<std::uint32_t> guarded{0};  ///< the start whose guard holds it
  std::atomic<std::uint32_t> wants_inhibits{0};  ///< the start that takes the second inhibits over
  std::atomic<std::uint32_t> left_inhibits{0};  ///< the start for which the keeper has let go of them
  std::atomic<std::int64_t> log_run{0};  ///< of the records of this flight's log, as on-board time in ns; 0: none yet
  std::atomic<std::uint64_t> log_number{0};  ///< of the newest record
  std::atomic<std::uint64_t> log_durable{0};  ///< up to here they are on the disk
  /// Of devices, the highest that a supervisor has noted as in use. Its file may be behind: whoever goes on begins above both.
  std::atomic<std::uint32_t> epoch_in_use{0};
  std::atomic<std::uint32_t> end_asked{0};  ///< number of the signal that asked for an end; 0: none did
  std::atomic<std::uint32_t> database{
      0};  ///< of the log since SET_DATABASE: 1 and a DatabaseStrategy; 0: the mission's
  static constexpr std::uint32_t end_of_time = 0xFFFF;  ///< in its place: the time of the flight is over
  std::atomic<std::uint64_t> stops_asked{0};  ///< by SIGUSR1, of the keeper or a guard, and on the guard's local socket
  std::atomic<std::uint64_t> stops_taken{
      0};  ///< those that a supervisor has noted what they mean for what it goes on with
  std::array<KeptInhibit, most_inhibits> inhibits;  ///< in the order of kept_endnodes()
  std::atomic<std::uint32_t> ends_told{0};
  std::array<KeptEnd, most_ends> ends;  ///< the newest
  /// By slot, 1: of what the supervisor handed over last the keeper had no descriptor free to take all. The supervisor clears it before it
  /// hands over, the keeper when it has taken a later one.
  std::array<std::atomic<std::uint8_t>, most_kept> not_taken{};
  /// By slot, other than 0: what the supervisor handed over last was not sent, so that what the keeper holds is of before. Set before it is sent,
  /// cleared behind that: a keeper that stands still, and to whom nothing can be sent any more, finds it all the same.
  std::array<std::atomic<std::uint8_t>, most_kept> not_sent{};
  /// When the first supervisor of the flight began its steps, as monotonic time in ns, which is every later one's too; 0: not yet.
  std::atomic<std::int64_t> flight_began{0};
  /// When the time of the flight is over, as monotonic time in ns; 0: it has as much as it likes. The keeper ends it then, or without one its
  /// supervisor.
  std::atomic<std::int64_t> ends_at{0};

  void tell_end(std::uint32_t pid, std::uint32_t how) noexcept {
    KeptEnd& place = ends[ends_told.load(std::memory_order_relaxed) % most_ends];
    place.pid.store(0, std::memory_order_release);
    place.how.store(how, std::memory_order_release);
    place.pid.store(pid, std::memory_order_release);
    ends_told.fetch_add(1, std::memory_order_release);
  }
  /// Empty: it was not told.
  [[nodiscard]] std::optional<std::uint32_t> end_of(std::uint32_t pid) const noexcept {
    for (const KeptEnd& end : ends)
      if (end.pid.load(std::memory_order_acquire) == pid) return end.how.load(std::memory_order_acquire);
    return std::nullopt;
  }
};

/// Stops that were asked for beside telecommands, from the count to the memory (docs/adr/0151): counted before they are carried out, which is
/// at once, and taken only when what they mean is noted: whoever dies in between, the next one stops all again and brings nobody back.
class AskedStops {
 public:
  explicit AskedStops(KeeperPage& page) noexcept : page_{page}, carried_out_{page.stops_taken.load()} {}

  /// One is asked for. Thread: any.
  void count() noexcept { page_.stops_asked.fetch_add(1); }
  /// All that are asked for so far, which `stop` carries out and makes known to the supervisor's loop. Thread: one at a time.
  /// \param stop Whether there are any that are not noted is its argument.
  template <class Stop>
  auto carry_out(Stop stop) {
    const std::uint64_t asked = page_.stops_asked.load();
    const auto outcome = stop(asked != page_.stops_taken.load());
    carried_out_.store(asked, std::memory_order_release);
    return outcome;
  }
  /// Before it hears of them: those that it will have heard of. Thread: the supervisor's loop.
  [[nodiscard]] std::uint64_t carried_out() const noexcept { return carried_out_.load(std::memory_order_acquire); }
  /// It has heard of them, and that is noted.
  void taken(std::uint64_t those) noexcept { page_.stops_taken.store(those); }

 private:
  KeeperPage& page_;
  std::atomic<std::uint64_t> carried_out_;
};

/// How long the keeper may stand still once it has moved.
inline constexpr Duration keeper_patience = std::chrono::seconds{3};
/// One that ends waits twice for its log, each time at most two seconds, and nothing moves any more. What the disk has not given back
/// by then, the system waits for.
inline constexpr Duration ending_patience = std::chrono::seconds{10};
/// A supervisor whose keeper is gone has the system end it where it neither steps nor ends for so long (docs/adr/0217).
inline constexpr unsigned alone_patience_s = std::chrono::duration_cast<std::chrono::seconds>(ending_patience).count();
/// The supervisor: less than its own guard grants it before all is fenced, so that another one can go on with what moves.
inline constexpr Duration supervisor_patience = std::chrono::milliseconds{800};
/// The same until its first step: it waits for no disk on the way there, and in that step it reads stored values, beside its guard. A disk that
/// stands still may hold it up in that, and keeps the one before from being reaped in the first place (docs/adr/0192).
inline constexpr Duration successor_patience = std::chrono::seconds{5};

/// Looks at one counter of the page from time to time.
class Progress {
 public:
  /// Of the time between two looks no more counts: while the whole computer was stopped neither could move.
  static constexpr Duration most_unwatched = std::chrono::milliseconds{400};
  /// \param before_the_first How long it may take until it moves for the first time.
  explicit Progress(Duration patience = keeper_patience, Duration before_the_first = Duration::max())
      : patience_{patience}, before_the_first_{before_the_first} {}
  /// True while it stands still for longer than the patience. A counter that is damaged has moved once.
  [[nodiscard]] bool stands_still(std::uint64_t count, TimePoint now) noexcept {
    if (has_looked_) still_ += std::min(now - looked_, most_unwatched);
    looked_ = now;
    has_looked_ = true;
    if (count != seen_) {
      seen_ = count;
      begun_ = true;
      still_ = Duration{0};
    }
    return still_ > (begun_ ? patience_ : before_the_first_);
  }

 private:
  Duration patience_, before_the_first_;
  std::uint64_t seen_{0};
  bool begun_{false};
  Duration still_{};
  TimePoint looked_{};
  bool has_looked_{false};
};

/// When another supervisor is started after one that has ended: at once, and after a pause that doubles where none lives long.
class Revivals {
 public:
  /// One that lived for so long does not count.
  static constexpr Duration long_enough = std::chrono::seconds{2};
  static constexpr std::uint32_t most = 5;
  static constexpr std::uint32_t at_once = 2;
  static constexpr Duration pause = std::chrono::milliseconds{100};
  /// Empty: so many have died young that the flight ends.
  [[nodiscard]] std::optional<Duration> next(Duration lived) noexcept {
    if (lived >= long_enough) in_a_row_ = 0;
    if (in_a_row_ == most) return std::nullopt;
    const std::uint32_t before = in_a_row_++;
    return before < at_once ? Duration{0} : pause * (1U << (before - at_once));
  }

 private:
  std::uint32_t in_a_row_{0};
};

}  // namespace hirosco::supervisor
