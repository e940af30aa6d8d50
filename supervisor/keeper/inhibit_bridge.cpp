// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/inhibit_bridge.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/subsystem/pages/supervisor_silence.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/life.hpp"
#include "hirosco/utilities/os/process.hpp"

namespace hirosco::supervisor {

namespace {
/// That of the guard.
constexpr int bridge_priority = 90;
constexpr std::size_t bridge_stack_octets = std::size_t{256} << 10;
/// Nothing depends on it: a wake-up that gets lost costs no more.
constexpr Duration longest_sleep = std::chrono::milliseconds{100};
}  // namespace

InhibitBridge::InhibitBridge(KeeperPage& page, FlowFactory& flows, std::vector<FlowAddress> endnodes)
    : page_{page}, flows_{flows} {
  for (FlowAddress& address : endnodes)
    if (lines_.size() < most_inhibits) lines_.push_back({std::move(address), nullptr});
}

InhibitBridge::~InhibitBridge() {
  ending_.store(true);
  wake_waiters(told_);
  thread_.join();
}

void InhibitBridge::watch(int supervisor) {
  // While it lives: of one that has ended nobody with real time opens anything (docs/adr/0240).
  ProcessThreads threads = ProcessThreads::of(supervisor);
  {
    const LockGuard lock{mutex_};
    std::swap(supervisor_, threads);
  }
  if (thread_.joinable()) return;
  if (auto thread = Thread::start("inhibits", [this] { run(); }, bridge_stack_octets)) thread_ = std::move(*thread);
}

void InhibitBridge::begin() {
  told_.store(page_.starts.load(), std::memory_order_release);
  wake_waiters(told_);
}

std::optional<std::uint32_t> InhibitBridge::lost() const noexcept {
  // Of those before the one that is waited for it is known.
  const std::uint32_t newest = std::max(start_, 1U);
  if (const std::uint32_t told = told_.load(std::memory_order_acquire); told >= newest) return told;
  // In order, or with everything that it has started: nobody goes on.
  if (forbidden_.load() || page_.finished.load() != 0 || page_.alone.load() != 0) return std::nullopt;
  const std::uint32_t guarded = page_.guarded.load(std::memory_order_acquire);
  const bool gone = life_of(page_.guard_life.load(std::memory_order_acquire)) == Life::Ended;
  return gone && guarded >= newest ? std::optional{guarded} : std::nullopt;
}

void InhibitBridge::stop() noexcept {
  for (KeptInhibit& inhibit : page_.inhibits) inhibit.withdraw();
}

void InhibitBridge::await(std::uint32_t start) {
  start_ = start;
  // Whoever has died before its guard told anything puts nothing off.
  if (start_ <= 2 || page_.wants_inhibits.load() == start_ - 1) until_.reset();
}

void InhibitBridge::begin_at(TimePoint now) {
  await(page_.starts.load() + 1);
  open(now);
}

void InhibitBridge::open(TimePoint now) {
  if (!until_) until_ = now + supervisor_silence_limit;
  try {
    for (Line& line : lines_)
      if (line.flow == nullptr)
        if (auto flow = flows_.open(line.address, FlowSide::Subsystem)) line.flow = std::move(*flow);
  } catch (const std::bad_alloc&) {
    // What kept the supervisor from going on may keep this from it, too: that device stops, and the keeper lives.
  }
}

bool InhibitBridge::has_all() const noexcept {
  return std::ranges::none_of(lines_, [](const Line& line) { return line.flow == nullptr; });
}

void InhibitBridge::let_go() noexcept {
  for (Line& line : lines_) line.flow.reset();
  // Where a start was refused the one that takes over is a later one than was waited for.
  page_.left_inhibits.store(std::max(start_, page_.wants_inhibits.load(std::memory_order_acquire)),
                            std::memory_order_release);
}

void InhibitBridge::run() {
  static_cast<void>(set_fifo_priority(bridge_priority));
  while (!ending_.load()) {
    const std::array words{SeenWord{&page_.guard_life, page_.guard_life.load(std::memory_order_acquire)},
                           SeenWord{&told_, told_.load(std::memory_order_acquire)}};
    if (const auto start = lost()) {
      go_between(*start);
    } else if (!wait_for_change(words, longest_sleep)) {
      sleep_until(SystemClock{}.now() + pace);
    }
  }
}

void InhibitBridge::go_between(std::uint32_t lost) {
  const SystemClock clock;
  // What it holds of endnodes it gives back last of all.
  if (page_.starts.load() == lost) {
    const LockGuard lock{mutex_};
    hurry_end(supervisor_);
  }
  const TimePoint began = clock.now();
  await(lost + 1);
  open(began);
  while (!ending_.load() && step(clock.now())) {
    const bool opens = !has_all() && clock.now() - began < longest_opening;
    sleep_until(clock.now() + (opens ? pace_of_opening : pace));
    if (opens) open(clock.now());
    // Another one that died before its guard told anything.
    if (const std::uint32_t told = told_.load(std::memory_order_acquire); told >= start_) await(told + 1);
  }
  let_go();
}

bool InhibitBridge::step(TimePoint now) noexcept {
  if (page_.wants_inhibits.load(std::memory_order_acquire) >= start_) {
    let_go();
    return false;
  }
  // A stop that no guard has taken yet: the one that died may have told to go on after it was asked.
  if (!until_ || now > *until_ || page_.stops_asked.load() != page_.stops_taken.load()) stop();
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    KeptInhibit& inhibit = page_.inhibits[i];
    if (lines_[i].flow == nullptr || inhibit.untold.load(std::memory_order_acquire) != 0) continue;
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
