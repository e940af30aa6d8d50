// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/member.hpp"

namespace hirosco::supervisor {

void Member::started(LaunchedSubsystem launched) {
  launched_ = std::move(launched);
  recovering.reset();
  going_down = false;
  closed_at.reset();
  refused = unreadable = unreadable_told = 0;
  next_unreadable_told = {};
}

void Member::died() { launched_ = {}; }

const VitalPage* Member::vital() const noexcept {
  if (launched_.vital.octets.size() < sizeof(VitalPage)) return nullptr;
  const auto* page = reinterpret_cast<const VitalPage*>(launched_.vital.octets.data());
  return page->magic == page_magic && page->version == page_version ? page : nullptr;
}

PermitPage* Member::permit() const noexcept {
  if (launched_.permit.octets.size() < sizeof(PermitPage)) return nullptr;
  return reinterpret_cast<PermitPage*>(launched_.permit.octets.data());
}

std::optional<State> Member::state() const noexcept {
  const VitalPage* page = vital();
  if (page == nullptr) return std::nullopt;
  const std::uint32_t state = page->state.load(std::memory_order_acquire);
  if (state > static_cast<std::uint32_t>(State::SoftwareDeinit)) return std::nullopt;
  return static_cast<State>(state);
}

std::uint8_t Member::configuration() const noexcept {
  const VitalPage* page = vital();
  return page != nullptr ? static_cast<std::uint8_t>(page->configuration.load(std::memory_order_relaxed)) : 0;
}

}  // namespace hirosco::supervisor
