// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/inhibit_bridge.hpp"

#include <array>
#include <utility>

#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/utilities/os/clock.hpp"

namespace hirosco::supervisor {

namespace {
/// That of the guard.
constexpr int bridge_priority = 90;
constexpr std::size_t bridge_stack_octets = std::size_t{256} << 10;
}  // namespace

InhibitBridge::InhibitBridge(KeeperPage& page, FlowFactory& flows, std::vector<FlowAddress> endnodes)
    : page_{page}, flows_{flows} {
  for (FlowAddress& address : endnodes)
    if (lines_.size() < most_inhibits) lines_.push_back({std::move(address), nullptr});
}

InhibitBridge::~InhibitBridge() {
  ending_.store(true);
  thread_.join();
}

void InhibitBridge::begin() {
  ending_.store(true);
  thread_.join();
  ending_.store(false);
  await_next();
  if (auto thread = Thread::start("inhibits", [this] { run(); }, bridge_stack_octets)) thread_ = std::move(*thread);
}

void InhibitBridge::stop() noexcept {
  for (KeptInhibit& inhibit : page_.inhibits) inhibit.go.store(0, std::memory_order_release);
}

void InhibitBridge::await_next() {
  start_ = page_.starts.load() + 1;
  // Whoever has died before its guard told anything puts nothing off.
  if (start_ <= 2 || page_.wants_inhibits.load() == start_ - 1) until_.reset();
}

void InhibitBridge::begin_at(TimePoint now) {
  await_next();
  open(now);
}

void InhibitBridge::open(TimePoint now) {
  if (!until_) until_ = now + supervisor_silence_limit;
  for (Line& line : lines_)
    if (auto flow = flows_.open(line.address, FlowSide::Subsystem)) line.flow = std::move(*flow);
}

void InhibitBridge::let_go() noexcept {
  for (Line& line : lines_) line.flow.reset();
  page_.left_inhibits.store(start_, std::memory_order_release);
}

void InhibitBridge::run() {
  static_cast<void>(set_fifo_priority(bridge_priority));
  const SystemClock clock;
  open(clock.now());
  while (!ending_.load() && step(clock.now())) sleep_until(clock.now() + pace);
  let_go();
}

bool InhibitBridge::step(TimePoint now) noexcept {
  if (page_.wants_inhibits.load(std::memory_order_acquire) >= start_) {
    let_go();
    return false;
  }
  if (!until_ || now > *until_) stop();
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    KeptInhibit& inhibit = page_.inhibits[i];
    if (lines_[i].flow == nullptr) continue;
    const std::uint32_t sequence = inhibit.sequence.fetch_add(1, std::memory_order_acq_rel) + 1;
    std::array<std::byte, enable_frame_octets> frame;
    const auto written = write_enable_command(frame, {.enabled = static_cast<std::uint8_t>(inhibit.enabled() ? 1 : 0),
                                                      .epoch = inhibit.epoch.load(std::memory_order_acquire),
                                                      .sequence = sequence});
    if (written) static_cast<void>(lines_[i].flow->send(*written));
  }
  return true;
}

}  // namespace hirosco::supervisor
