// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "supervisor/guard/guarded_member.hpp"

namespace hirosco::supervisor {

/// What the guard found, until the supervisor's loop takes it, and who wakes that loop for it. Findings that nobody takes cannot fill the memory, and
/// none of them is lost.  Thread: under the guard's mutex.
class GuardFindings {
 public:
  /// \param on_finding Wakes the supervisor's loop, in the thread that found something; may be empty.
  explicit GuardFindings(std::function<void()> on_finding) : on_finding_{std::move(on_finding)} {}

  /// As many as are kept each on its own take no heap from then on.
  void reserve();
  void find_out(GuardFinding::Kind kind, std::uint16_t apid, std::uint16_t device = 0);
  /// There is something to be asked for, though nothing was found.
  void wake() const;
  [[nodiscard]] std::vector<GuardFinding> take();
  /// What was found of the process before is no matter of the next one.
  void forget_end_of(std::uint16_t apid);

 private:
  std::function<void()> on_finding_;
  std::vector<GuardFinding> findings_;
};

}  // namespace hirosco::supervisor
