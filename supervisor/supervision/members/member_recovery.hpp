// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "hirosco/descriptor/model/subsystem.hpp"

namespace hirosco::supervisor {

/// What a member is in the middle of: a recovery of a severity, its way down with its network. Each that has a part in it says
/// what happened, and nobody else sets anything. What a plan that fails leads to: `event_handling/reactions.cpp`. Thread: the supervisor's.
class MemberRecovery {
 public:
  /// A plan that holds its subject begins; it overrides what ran.
  void plan_begins(descriptor::Severity severity) noexcept { running_ = severity; }
  /// That plan has ended. One that something of another severity has overridden ends nothing, nor does any plan while its
  /// subject goes down.
  void plan_ended(descriptor::Severity severity) noexcept {
    if (!going_down_ && running_ == severity) running_.reset();
  }
  /// Its network goes down, the gravest there is. \return true for who is to lead it there: it was not on that way already.
  [[nodiscard]] bool goes_down() noexcept {
    running_ = descriptor::Severity::High;
    return !std::exchange(going_down_, true);
  }
  /// The end of that way, wherever it ended.
  void came_down() noexcept {
    if (running_ == descriptor::Severity::High) *this = {};
  }
  /// It runs in a new process: what was begun with the last one is over.
  void started() noexcept { *this = {}; }

  /// A recovery runs for it, on its way down or not.
  [[nodiscard]] bool running() const noexcept { return running_.has_value(); }
  /// On its way to Offline with its network.
  [[nodiscard]] bool going_down() const noexcept { return going_down_; }
  /// What runs is as grave as this, or graver: nothing begins beside it.
  [[nodiscard]] bool outweighs(descriptor::Severity severity) const noexcept {
    return running_ && *running_ >= severity;
  }

 private:
  std::optional<descriptor::Severity> running_;
  bool going_down_{false};
};

}  // namespace hirosco::supervisor
