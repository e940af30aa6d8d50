// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Requirement F11: the cycle never waits. Duration of one 2 kHz cycle (write queue, 64-octet parameters, housekeeping
// samples, 20 us of control work) alone, beside ten threads that never touch the dictionary, and beside five writers
// and five readers without a pause. Run it on an otherwise idle machine; SCHED_FIFO where permitted.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include "hirosco/parameter/testing/whole_data.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

using namespace hirosco;
using hirosco::testing::Checked;

namespace {

constexpr std::size_t parameters = 6;
constexpr std::size_t octets = sizeof(Checked);
enum class Load { None, Unrelated, Dictionary };

struct Craft {
  Craft() {
    std::vector<ParameterSpec> specs;
    for (std::size_t i = 0; i < parameters; ++i)
      specs.push_back({"PARAMETER_" + std::to_string(i),
                       {1, Type::Struct, static_cast<std::uint8_t>(i)},
                       {{"WRITER", Type::Uint64, 1}, {"COUNT", Type::Uint64, 1}, {"MIXED", Type::Uint64, 6}},
                       true,
                       {}});
    dictionary = std::move(*Dictionary::make(specs));
    for (std::size_t i = 0; i < parameters; ++i) static_cast<void>(dictionary.publish(specs[i].name, cells[i]));
  }
  Dictionary dictionary;
  std::array<Parameter<Checked>, parameters> cells;
  WriteQueue queue{4, octets + 16};
  std::atomic<bool> stop{false};
};

void write_without_pause(Craft& craft, std::uint16_t index) {
  const std::array<std::byte, octets> value{};
  while (!craft.stop.load(std::memory_order_relaxed))
    if (!craft.queue.enqueue(craft.dictionary, {{{index, -1, value}}})) std::this_thread::yield();
}
void read_without_pause(Craft& craft, std::size_t index) {
  std::array<std::byte, octets> value{};
  while (!craft.stop.load(std::memory_order_relaxed))
    static_cast<void>(craft.dictionary.snapshot_encode(index, -1, value));
}
void compute_without_pause(Craft& craft) {
  for (volatile double x = 0; !craft.stop.load(std::memory_order_relaxed);) x = std::sin(x + 1.0);
}

/// One cycle; returns something so that nothing is optimised away.
double cycle(Craft& craft, std::uint64_t count) {
  craft.queue.apply(craft.dictionary);
  double state = static_cast<double>(count);
  for (int i = 0; i < 1500; ++i) state = std::sin(state) + 0.5;
  std::array<std::byte, octets> sample{};
  for (std::size_t i = 0; i < parameters; ++i) {
    craft.cells[i].store(Checked::made(i, count));
    state += static_cast<double>(craft.dictionary.encode(i, -1, sample));
  }
  return state;
}

std::vector<double> durations_us(Load load, std::size_t cycles) {
  Craft craft;
  std::vector<std::thread> threads;
  for (std::uint16_t i = 0; i < 5 && load != Load::None; ++i) {
    if (load == Load::Dictionary) {
      threads.emplace_back([&craft, i] { write_without_pause(craft, i); });
      threads.emplace_back([&craft, i] { read_without_pause(craft, i); });
    } else {
      for (int twice = 0; twice < 2; ++twice) threads.emplace_back([&craft] { compute_without_pause(craft); });
    }
  }
  std::vector<double> found;
  found.reserve(cycles);
  std::thread control{[&] {
    static_cast<void>(set_fifo_priority(50));
    const SystemClock clock;
    TimePoint wake = clock.now();
    double sum = 0;
    for (std::size_t i = 0; i < cycles; ++i) {
      sleep_until(wake += 500us);
      const TimePoint begin = clock.now();
      sum += cycle(craft, i);
      found.push_back(seconds(clock.now() - begin) * 1e6);
    }
    if (sum == 0.0) std::puts("");
  }};
  control.join();
  craft.stop.store(true);
  for (auto& thread : threads) thread.join();
  std::ranges::sort(found);
  return found;
}

}  // namespace

int main() {
  constexpr std::size_t cycles = 20'000;
  std::printf("SCHED_FIFO %s\n%-28s %8s %8s %8s %8s us\n", realtime_permitted() ? "yes" : "no", "beside", "p50", "p99",
              "p99.9", "max");
  for (const auto& [load, text] : {std::pair{Load::None, "nothing"}, std::pair{Load::Unrelated, "10 unrelated threads"},
                                   std::pair{Load::Dictionary, "5 writers and 5 readers"}}) {
    const auto found = durations_us(load, cycles);
    std::printf("%-28s %8.2f %8.2f %8.2f %8.2f\n", text, found[cycles / 2], found[cycles * 99 / 100],
                found[cycles * 999 / 1000], found.back());
  }
}
