// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#pragma once

#include <cstdint>

#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/subsystem/pages/inhibition.hpp"

namespace hirosco {

/// In which state the cycle is, and why its actuators are inhibited (pages/inhibition.hpp): all parts of the cycle decide by it. The state is written by
/// CycleLoop alone. A reason is latched until Operational is entered; inhibited_while_awaited passes by itself, cycle by cycle.
/// Realtime: wait-free. Thread: the cycle's, begin() while it rests.
class ControlState {
 public:
  /// Another configuration: Pre-Operational, nothing is inhibited.
  void begin() noexcept {
    state_ = State::PreOperational;
    inhibited_ = 0;
  }
  /// Of the reasons nothing changes.
  void enter(State state) noexcept { state_ = state; }
  void inhibit(Inhibition reason) noexcept { inhibited_ |= reason; }
  /// Operational is entered: what was latched before holds no more.
  void clear() noexcept { inhibited_ = 0; }
  /// What inhibits only while it is waited for is looked at anew.
  void clear_awaited() noexcept { inhibited_ &= ~static_cast<std::uint32_t>(inhibited_while_awaited); }

  [[nodiscard]] State state() const noexcept { return state_; }
  /// Safe-Operational or Operational: in these an input that is lost is a matter of safety.
  [[nodiscard]] bool controlling() const noexcept {
    return state_ == State::SafeOperational || state_ == State::Operational;
  }
  /// What the author puts out reaches the actuators.
  [[nodiscard]] bool active() const noexcept { return state_ == State::Operational && inhibited_ == 0; }
  /// Bits of Inhibition.
  [[nodiscard]] std::uint32_t inhibited() const noexcept { return inhibited_; }
  /// A node failed, or an output jumped, and Operational was not entered since.
  [[nodiscard]] bool failed() const noexcept { return (inhibited_ & inhibited_by_failure) != 0; }

 private:
  State state_{State::PreOperational};
  std::uint32_t inhibited_{0};
};

}  // namespace hirosco
