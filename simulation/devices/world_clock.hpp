// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/utilities/time.hpp"

namespace hirosco::simulation {

/// By which cycles a simulated device's world moves, so that it keeps up with the craft's clock: driven by the exchange of frames, and by
/// the clock once a command is overdue by a cycle.
/// A pause of this very program (a stopped virtual machine, a debugger) is no time that the device had: real hardware would have run on,
/// so its world may not jump.
/// Realtime: wait-free. Thread: one.
class WorldClock {
 public:
  /// `rate`: how fast the world runs against the craft; 1 is right.
  WorldClock(Duration cycle, double rate) noexcept : cycle_{cycle}, rate_{rate} {}

  /// What a program that was held up did not see of the time since its last step.
  struct Held {
    Duration pause{};  ///< beyond the step that was planned
    Duration starved{};  ///< the planned step, where the pause was no jitter
  };
  /// A step begins.
  [[nodiscard]] Held wake(TimePoint now) noexcept;
  /// Cycles by which the world is to move in this step. `exchanged`: a command drives it.
  [[nodiscard]] std::int64_t due(TimePoint now, bool exchanged) noexcept;
  /// It has moved by them.
  void count(std::int64_t cycles, bool exchanged) noexcept;

  /// What passes in the world in one cycle.
  [[nodiscard]] Duration world_cycle() const noexcept;
  /// When it moves by itself if no frame comes; of a clock that has not begun, now().
  [[nodiscard]] TimePoint next() const noexcept { return started_ ? world_time_ + planned_step() : now_; }
  [[nodiscard]] bool started() const noexcept { return started_; }
  /// Of the last step.
  [[nodiscard]] TimePoint now() const noexcept { return now_; }
  /// That the world has moved, and how many of them the own clock drove.
  [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }
  [[nodiscard]] std::uint64_t own_cycles() const noexcept { return own_cycles_; }

 private:
  /// From where the world is to the next time that it moves by itself.
  [[nodiscard]] Duration planned_step() const noexcept { return cycle_ * (by_own_clock_ ? 1 : 2); }

  Duration cycle_;
  double rate_;
  bool started_{false};
  bool by_own_clock_{true};
  TimePoint now_{};
  TimePoint world_time_{};  // up to where the world has moved
  std::uint64_t cycles_{0};
  std::uint64_t own_cycles_{0};
};

}  // namespace hirosco::simulation
