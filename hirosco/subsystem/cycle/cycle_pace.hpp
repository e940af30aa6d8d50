// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/time.hpp"

/// When cycles begin: by the clock, or, in a configuration that says so, with the sample that arrives (adr 0094).
namespace hirosco {

/// What may start a cycle before it is due.
struct CycleWait {
  const std::uint32_t* word{nullptr};  ///< changes when a sample arrives; null: the clock alone starts it
  std::uint32_t seen{0};  ///< of the word, before the last cycle read its samples
  TimePoint earliest{};  ///< nobody is woken before
  Duration least{};  ///< who was woken without a sample rests so long before it waits again
  Duration
      spin{};  ///< of a precise cycle: from the wake-up, at which it begins to look at the clock, to when it is due

  [[nodiscard]] bool arrived() const noexcept;
};

/// One per cycle loop; begun anew with each configuration.  Realtime: wait-free. Thread: the cycle.
class CyclePace {
 public:
  /// `precise`: the platform lets a cycle spin that asks for it.
  void begin(const descriptor::Configuration& configuration, bool precise) noexcept;

  /// How a cycle began.
  struct Start {
    TimePoint planned;  ///< what its samples are of, and from which the next one is due
    bool arrived{false};  ///< a sample started it
    /// Limits that are counted in cycles go on. In cycles by the clock always; of those that samples start only with each whole
    /// longest wait, so that a quick producer makes no limit short, and a pause of the whole computer counts once.
    bool counts{true};
  };
  [[nodiscard]] Start start(TimePoint planned, TimePoint started) noexcept;
  /// In the cycle, before samples are read. Null: there is no link.
  void look(const std::uint32_t* word) noexcept;
  /// After that: whether what comes over the link is to be relied on. If not, the clock goes on alone.
  void rely(bool reliable) noexcept {
    if (!reliable) wait_.word = nullptr;
  }
  struct Next {
    TimePoint due;
    std::uint64_t skipped{0};  ///< cycles of the clock that were due before this one had ended
  };
  [[nodiscard]] Next next(TimePoint planned, TimePoint finished) const noexcept;
  [[nodiscard]] const CycleWait& wait() const noexcept { return wait_; }

 private:
  Duration longest_{};
  Duration least_{};
  bool by_samples_{false};
  bool counted_{false};
  TimePoint counted_at_{};
  CycleWait wait_;
};

}  // namespace hirosco
