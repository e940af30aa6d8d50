// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "hirosco/pus/packet/packet_counters.hpp"
#include "hirosco/subsystem/pages/inhibition.hpp"
#include "hirosco/utilities/time.hpp"

/// The two pages of shared memory between a subsystem and the supervisor (decision 6). Both sides check magic and
/// version before use; all fields are single words, so nothing can be torn. What decides over actuators survives damage: no
/// flip of a single bit permits anything, or turns one state into another (docs/adr/0019).
namespace hirosco {

inline constexpr std::uint32_t page_magic = 0x48495243;  // "HIRC"
inline constexpr std::uint32_t page_version = 8;

/// A real-time link as its consumer sees it, since the link was made.
struct IncomingLink {
  std::atomic<std::uint32_t> link{0};  ///< id, 0 = none
  std::atomic<std::uint32_t> lost{0};  ///< samples that came and went between two cycles
  /// From the instant that a sample is of (its producer's planned cycle) to the start of the cycle that uses it first.
  std::atomic<std::uint32_t> latency_mean_ns{0};  ///< over about the last 1,000 samples
  std::atomic<std::uint32_t> latency_max_ns{0};
  /// Mean distance of the latencies of two samples in a row, as RFC 3550 (6.4.1) reckons the jitter of arrivals.
  std::atomic<std::uint32_t> jitter_ns{0};
  std::atomic<std::uint32_t> age_us{
      0};  ///< from the instant that the newest sample is of to the start of the newest cycle
};
/// As many as a configuration can require, by itself and from its subsystem together: of each link of a consumer is told.
inline constexpr std::size_t told_incoming_links = 64;

/// Into so many bins the latencies of a link are counted (docs/adr/0141). Their bounds double, and one of them is the period of the link:
/// at most 1/64, 1/32, 1/16, 1/8, 1/4, 1/2, 1 and 2 periods, and all above.
inline constexpr std::size_t latency_bins = 9;

/// The bin of a latency, whatever a stamp from outside makes of it; what is not after its instant is in the first. A period of nothing
/// counts as 1 ns.
/// Realtime: wait-free.
[[nodiscard]] constexpr std::size_t latency_bin(Duration latency, Duration period) noexcept {
  constexpr std::uint64_t parts = 64;
  constexpr std::int64_t longest = std::int64_t{1} << 56;
  const auto before = static_cast<std::uint64_t>(std::clamp<std::int64_t>(latency.count(), 1, longest) - 1);
  const std::uint64_t passed = before * parts / static_cast<std::uint64_t>(std::max<std::int64_t>(period.count(), 1));
  return std::min(static_cast<std::size_t>(std::bit_width(passed)), latency_bins - 1);
}

/// How long the samples of an incoming link took, since the link was made.
struct LinkLatencies {
  std::atomic<std::uint32_t> period_ns{0};  ///< of the producer: what the bins are parts of; 0 = nothing is counted
  std::array<std::atomic<std::uint32_t>, latency_bins> counts{};  ///< of samples in each bin
};

/// Values of VitalPage::judged: what a consumer's cycle makes of a set that it requires, whatever its samples travel by (docs/adr/0166).
enum LinkJudgement : std::uint32_t {
  link_not_judged = 0,  ///< not valid, and nobody controls by it, or its first sample is still awaited
  link_valid = 1,  ///< as its author sees it
  link_stale = 2,  ///< too old, reported faulty or absent while it controls: NAME_STALE, unless it was ended in order
};

/// A number of 16 bits beside its complement: damage shows.  Realtime: wait-free.
class CheckedWord {
 public:
  /// What load() says of a word that is neither: larger than every value.
  static constexpr std::uint32_t damaged = 0xFFFF'FFFF;
  CheckedWord(std::uint32_t value = 0) noexcept : word_{coded(value)} {}  // NOLINT: stands for the number
  CheckedWord& operator=(std::uint32_t value) noexcept {
    store(value);
    return *this;
  }
  void store(std::uint32_t value, std::memory_order order = std::memory_order_seq_cst) noexcept {
    word_.store(coded(value), order);
  }
  [[nodiscard]] std::uint32_t load(std::memory_order order = std::memory_order_seq_cst) const noexcept {
    const std::uint32_t word = word_.load(order);
    return word == coded(word & 0xFFFF) ? word & 0xFFFF : damaged;
  }

 private:
  [[nodiscard]] static constexpr std::uint32_t coded(std::uint32_t value) noexcept {
    return (value & 0xFFFF) | (~value << 16);
  }
  std::atomic<std::uint32_t> word_;
};

/// Written by the subsystem, read by the supervisor.
struct VitalPage {
  std::uint32_t magic{page_magic};
  std::uint32_t version{page_version};
  CheckedWord state{0};  ///< State
  CheckedWord configuration{0};  ///< id, 0 = none
  std::atomic<std::uint32_t> inhibited{0};  ///< bits of Inhibition
  std::atomic<std::uint32_t> seen_epoch{0};  ///< epoch of the permit page at the last cycle
  CheckedWord realtime{0};  ///< 1: SCHED_FIFO granted, 0: the reduced promise holds
  CheckedWord cycling{0};  ///< 1 from a configuration until the cycle rests again
  std::atomic<std::uint64_t> period_ns{0};
  std::atomic<std::uint64_t> cycles{0};  ///< advances while the cycle runs: hang detection
  std::atomic<std::uint64_t> service_steps{0};  ///< advances while the service loop runs
  std::atomic<std::uint64_t> overruns{0};  ///< cycles whose own work took longer than the period
  std::atomic<std::uint64_t> missed{0};  ///< cycles skipped because they were due before the last had ended
  std::atomic<std::uint32_t> latency_max_ns{0};  ///< wake-up after its planned time, largest since configuration
  std::atomic<std::uint32_t> execution_max_ns{0};
  std::atomic<std::uint32_t> execution_mean_ns{0};  ///< over about the last 1,000 cycles
  std::atomic<std::uint32_t> lost_reports{0};  ///< cycle-side reports that found no room
  std::atomic<std::uint64_t> inhibited_at_cycle{0};  ///< `cycles` in which the actuators were inhibited last
  std::array<IncomingLink, told_incoming_links> incoming;  ///< in the order of <Requires>
  pus::CounterBlock counters;  ///< outlive the process (decision 8b)
  std::atomic<std::uint32_t> life{
      0};  ///< marked by the system when the process ends (hirosco/utilities/os/life.hpp); 0: nobody holds it
  std::array<LinkLatencies, told_incoming_links> latencies;  ///< of each of `incoming`
  /// LinkJudgement of each of `incoming`, from the beginning of a cycle on.
  std::array<std::atomic<std::uint32_t>, told_incoming_links> judged{};
};

/// Values of PermitPage::powered.
enum Power : std::uint32_t {
  power_off = 0,  ///< each switch has said that it is off; also of who has none
  power_on = 1,  ///< each switch has said that it is on
  power_changes = 2,  ///< neither
  power_unknown_version = 3,  ///< one answers by frames of another version: what it says nobody here can read
};

/// The only value of PermitPage::go that lets actuators move under this epoch.
[[nodiscard]] constexpr std::uint64_t permission_word(std::uint32_t epoch) noexcept {
  std::uint64_t word = epoch + 0x9E37'79B9'7F4A'7C15;
  word = (word ^ (word >> 30)) * 0xBF58'476D'1CE4'E5B9;
  word = (word ^ (word >> 27)) * 0x94D0'49BB'1331'11EB;
  return word ^ (word >> 31);
}

/// Written by the supervisor, read by the subsystem every cycle. As it is made it permits nothing.
struct PermitPage {
  std::uint32_t magic{page_magic};
  std::uint32_t version{page_version};
  std::atomic<std::uint32_t> epoch{1};  ///< rises with every fence and every release; device frames carry it
  std::atomic<std::uint32_t> stop{0};  ///< 1 after a fence, for displays: what decides is `go`
  std::atomic<std::uint64_t> go{0};  ///< permission_word(epoch): actuators may move; everything else: they may not
  std::atomic<std::uint32_t> mode_epoch{0};  ///< rises with every mode change
  /// Rises with every stop of everything, never 0 in a flight: what was said under another number lets nobody move (docs/adr/0156).
  std::atomic<std::uint32_t> newest_stop{0};
  std::atomic<std::uint64_t> heartbeat{0};  ///< advances with every step of the supervisor
  std::atomic<std::uint64_t> stopped_at_cycle{0};  ///< VitalPage::cycles that the supervisor read when it set `stop`
  CheckedWord powered{0};  ///< Power: what the switches of its devices say

  /// Actuators may move under this epoch.  Realtime: wait-free.
  [[nodiscard]] bool permits(std::uint32_t under) const noexcept {
    return go.load(std::memory_order_acquire) == permission_word(under);
  }
  /// The writer's two acts. The order of the stores leaves no instant in which an old permission holds for a new epoch.
  void fence() noexcept {
    go.store(0, std::memory_order_release);
    epoch.fetch_add(1, std::memory_order_acq_rel);
    stop.store(1, std::memory_order_release);
  }
  void release() noexcept {
    go.store(0, std::memory_order_release);
    const std::uint32_t under = epoch.fetch_add(1, std::memory_order_acq_rel) + 1;
    stop.store(0, std::memory_order_release);
    go.store(permission_word(under), std::memory_order_release);
  }
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace hirosco
