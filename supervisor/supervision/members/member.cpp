// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/members/member.hpp"

namespace hirosco::supervisor {

void Member::started(LaunchedSubsystem launched) {
  launched_ = std::move(launched);
  recovery.started();
  closed_at.reset();
  refused = unreadable = unreadable_told = 0;
  why_unreadable = {};
  next_unreadable_told = {};
}

void Member::died() { launched_ = {}; }

std::optional<MemberStatistics> Member::statistics() const noexcept {
  return alive() ? launched_.port->statistics() : std::nullopt;
}

std::uint64_t Member::stopped_at_cycle() const noexcept { return alive() ? launched_.port->stopped_at_cycle() : 0; }

void Member::enter_mode(std::uint32_t epoch) noexcept {
  if (alive()) launched_.port->enter_mode(epoch);
}

void Member::beat(std::uint64_t heartbeat, TimePoint now) {
  if (alive()) launched_.port->beat(heartbeat, now);
}

}  // namespace hirosco::supervisor
