// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/member.hpp"

#include <algorithm>

namespace hirosco::supervisor {

void Member::started(LaunchedSubsystem launched) {
  launched_ = std::move(launched);
  last_cycles_ = 0;
  still_steps_ = 0;
  recovering.reset();
  going_down = false;
  closed_at.reset();
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

void Member::fence() noexcept {
  PermitPage* page = permit();
  if (page == nullptr) return;
  if (const VitalPage* own = vital(); own != nullptr && page->stop.load(std::memory_order_relaxed) == 0)
    page->stopped_at_cycle.store(own->cycles.load(std::memory_order_acquire), std::memory_order_relaxed);
  page->stop.store(1, std::memory_order_release);
  page->epoch.fetch_add(1, std::memory_order_acq_rel);
}

void Member::release_fence() noexcept {
  if (PermitPage* page = permit()) page->stop.store(0, std::memory_order_release);
}

bool Member::fenced() const noexcept {
  const PermitPage* page = permit();
  return page != nullptr && page->stop.load(std::memory_order_acquire) != 0;
}

bool Member::hang_detected() {
  const VitalPage* page = vital();
  if (page == nullptr || page->cycling.load(std::memory_order_acquire) == 0) {
    still_steps_ = 0;
    return false;
  }
  const std::uint64_t cycles = page->cycles.load(std::memory_order_acquire);
  still_steps_ = cycles == last_cycles_ ? still_steps_ + 1 : 0;
  last_cycles_ = cycles;
  const bool realtime = page->realtime.load(std::memory_order_relaxed) != 0;
  const std::uint32_t limit = realtime ? descriptor().hang.realtime : descriptor().hang.reduced;
  // A slow cycle stands still between its steps: three of its own periods are granted at least.
  const auto* configured = descriptor().find_configuration(configuration());
  const auto slow = configured != nullptr ? 3 * configured->sampling / observation_period : 0;
  return still_steps_ == std::max(limit, static_cast<std::uint32_t>(slow));
}

}  // namespace hirosco::supervisor
