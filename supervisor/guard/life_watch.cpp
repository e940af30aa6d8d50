// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/life_watch.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <vector>

#include "hirosco/utilities/os/life.hpp"

namespace hirosco::supervisor {
namespace {

static_assert(LifeWatch::most < most_seen_words);
constexpr std::size_t watch_stack_octets = std::size_t{128} << 10;
/// Nothing depends on it: a wake-up that gets lost costs no more.
constexpr Duration longest_sleep = std::chrono::seconds{1};

}  // namespace

Result<std::unique_ptr<LifeWatch>> LifeWatch::start(Guard& guard) {
  std::unique_ptr<LifeWatch> watch{new LifeWatch{guard}};
  const std::array probe{SeenWord{&guard.changes(), guard.changes().load(std::memory_order_acquire)}};
  HIROSCO_TRY(wait_for_change(probe, Duration{0}));
  HIROSCO_TRY_LET(watch->thread_, Thread::start("ends", [self = watch.get()] { self->run(); }, watch_stack_octets));
  return watch;
}

LifeWatch::~LifeWatch() {
  ended_.store(true);
  wake_waiters(guard_.changes());
  thread_.join();
}

void LifeWatch::run() {
  static_cast<void>(set_fifo_priority(priority));
  while (!ended_.load()) {
    const std::uint32_t changes = guard_.changes().load(std::memory_order_acquire);
    const std::vector<Guard::WatchedLife> lives = guard_.lives();
    const std::size_t count = std::min(lives.size(), most);
    std::array<SeenWord, most_seen_words> words{};
    words[0] = {&guard_.changes(), changes};
    for (std::size_t i = 0; i < count; ++i) words[i + 1] = {lives[i].word, lives[i].seen};
    if (!wait_for_change(std::span{words}.first(count + 1), longest_sleep)) return;
    for (std::size_t i = 0; i < count; ++i)
      if (lives[i].word->load(std::memory_order_acquire) != lives[i].seen) guard_.life_changed(lives[i].apid);
  }
}

}  // namespace hirosco::supervisor
