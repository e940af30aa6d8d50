// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Whether a cycle waits for those who write and read its parameters (requirement F11): from the instant it is due until it has taken 16 batches and
// stored a structure of its own, with five writers and five readers at its dictionary, against the same cycle while the ten do as much at another one.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/parameter/testing/whole_data.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

using hirosco::testing::Checked;

constexpr Duration period = 500us;
constexpr Duration lead = 100us;  ///< from when it fills its queue up until it is due
constexpr int priority = 80;
constexpr std::size_t written_by_others = 5, parameters = written_by_others + 1;  ///< the last one is the cycle's own
constexpr std::size_t batches = 16;
constexpr std::uint64_t writers = 5, readers = 5;
constexpr int turns = 4;  ///< of both contestants in one repeat: what the computer does meanwhile falls on both

/// Parameters of a subsystem, and what waits to be written into them.
class Values {
 public:
  Values() {
    for (std::size_t i = 0; i < parameters; ++i) {
      cells_[i].store(Checked::made(0, i));
      static_cast<void>(dictionary_.publish(specs_[i].name, cells_[i]));
    }
  }
  Values(const Values&) = delete;
  Values& operator=(const Values&) = delete;

  /// Two structures at once. False: the queue is full. Thread: any but the cycle's, or the cycle's between two cycles.
  bool offer(std::uint64_t writer, std::uint64_t count) {
    Parameter<Checked> scratch;
    std::array<std::array<std::byte, sizeof(Checked)>, 2> values{};
    for (auto& value : values) {
      scratch.store(Checked::made(writer, count));
      static_cast<void>(scratch.encode(scratch.fields(), value));
    }
    const auto first = static_cast<std::uint16_t>((writer + count) % written_by_others);
    const auto second = static_cast<std::uint16_t>((first + 1U) % written_by_others);
    return queue_.enqueue(dictionary_, std::array<ParameterWrite, 2>{{{first, -1, values[0]}, {second, -1, values[1]}}})
        .has_value();
  }
  /// Batches that were applied. Thread: the cycle's.
  std::size_t take(std::uint64_t count) noexcept {
    const std::size_t applied = queue_.apply(dictionary_);
    cells_[written_by_others].store(Checked::made(0, count));
    return applied;
  }
  /// False: torn. One that stores were in the way of too often is none. Thread: any.
  [[nodiscard]] bool whole(std::size_t parameter) const noexcept {
    Checked seen{};
    return !cells_[parameter].snapshot(seen) || seen.whole();
  }

 private:
  static std::vector<ParameterSpec> specs() {
    std::vector<ParameterSpec> all;
    for (std::size_t i = 0; i < parameters; ++i)
      all.push_back({"CHECKED_" + std::to_string(i),
                     {1, Type::Struct, static_cast<std::uint8_t>(i)},
                     {{"WRITER", Type::Uint64, 1}, {"COUNT", Type::Uint64, 1}, {"MIXED", Type::Uint64, 6}},
                     true,
                     {}});
    return all;
  }
  std::vector<ParameterSpec> specs_{specs()};
  Dictionary dictionary_{std::move(*Dictionary::make(specs_))};
  std::array<Parameter<Checked>, parameters> cells_;
  WriteQueue queue_{batches, 2 * (sizeof(Checked) + 12) + 4};
};

/// Ten threads of ordinary scheduling at some values, until it goes.
class Others {
 public:
  explicit Others(Values& values) {
    for (std::uint64_t i = 1; i <= writers; ++i)
      threads_.emplace_back([this, &values, i] {
        for (std::uint64_t count = 0; !ended_.load(std::memory_order_relaxed); ++count) {
          if (values.offer(i, count)) written_.fetch_add(1, std::memory_order_relaxed);
          else std::this_thread::yield();
        }
      });
    for (std::uint64_t i = 0; i < readers; ++i)
      threads_.emplace_back([this, &values, i] {
        for (std::uint64_t count = i; !ended_.load(std::memory_order_relaxed); ++count)
          if (!values.whole(count % parameters)) torn_.fetch_add(1, std::memory_order_relaxed);
          else read_.fetch_add(1, std::memory_order_relaxed);
      });
  }
  ~Others() {
    ended_.store(true);
    for (auto& thread : threads_) thread.join();
  }
  Others(const Others&) = delete;
  Others& operator=(const Others&) = delete;
  [[nodiscard]] bool were_at_work() const { return written_.load() > 0 && read_.load() > 0; }
  [[nodiscard]] std::uint64_t torn() const { return torn_.load(); }

 private:
  std::atomic<bool> ended_{false};
  std::atomic<std::uint64_t> written_{0}, read_{0}, torn_{0};
  std::vector<std::thread> threads_;
};

/// Takes what is written to values that no cycle has, as often as one would.
class Taker {
 public:
  Taker(const Clock& clock, Values& values)
      : thread_{[this, &clock, &values] {
          for (std::uint64_t count = 0; !ended_.load(std::memory_order_relaxed); ++count) {
            sleep_until(clock.now() + period);
            static_cast<void>(values.take(count));
          }
        }} {}
  ~Taker() {
    ended_.store(true);
    thread_.join();
  }
  Taker(const Taker&) = delete;
  Taker& operator=(const Taker&) = delete;

 private:
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

struct Cycles {
  std::vector<std::int64_t> until_done, work;
  bool each_had_all{true};
};

[[nodiscard]] Cycles run_cycles(const Clock& clock, Values& values, int cycles, bool realtime) {
  Cycles found;
  found.until_done.reserve(static_cast<std::size_t>(cycles));
  found.work.reserve(static_cast<std::size_t>(cycles));
  // As its own writer before each cycle, so that each has as much to take whoever else writes.
  const auto fill = [&](int count) {
    while (values.offer(0, static_cast<std::uint64_t>(count))) {}
  };
  if (realtime) (void)set_fifo_priority(priority);
  TimePoint due = clock.now() + period;
  for (int i = 0; i < cycles; ++i) {
    sleep_until(due - lead);
    fill(i);
    sleep_until(due);
    const TimePoint begun = clock.now();
    const std::size_t taken = values.take(static_cast<std::uint64_t>(i));
    const TimePoint done = clock.now();
    found.each_had_all = found.each_had_all && taken >= batches;
    found.until_done.push_back((done - due).count());
    found.work.push_back((done - begun).count());
    do due += period;
    while (due - lead <= done);
  }
  (void)set_ordinary_scheduling();
  return found;
}

int run(int repeats, int cycles) {
  const SystemClock clock;
  (void)lock_memory();
  const bool realtime = realtime_permitted();
  Series shared{"cycle, dictionary shared", {}}, own{"cycle, dictionary its own", {}};
  Series shared_work{"its work, shared", {}}, own_work{"its work, its own", {}};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::array<Cycles, 2> of_both;
    for (int turn = 0; turn < 2 * turns; ++turn) {
      const bool at_ours = turn % 4 == 1 || turn % 4 == 2;  // each first in every other turn
      Values ours, theirs;
      const Taker taker{clock, theirs};
      const Others others{at_ours ? ours : theirs};
      Cycles found;
      // On a thread of its own: those of the others began without its processor and its priority.
      std::thread cycle{[&] {
        (void)pin_to_cpu(0);
        found = run_cycles(clock, ours, std::max(cycles / turns, 1), realtime);
      }};
      cycle.join();
      if (!found.each_had_all || !others.were_at_work() || others.torn() != 0) {
        std::fprintf(stderr, "%llu structures torn, or somebody had nothing to do: that is no figure\n",
                     static_cast<unsigned long long>(others.torn()));
        return EXIT_FAILURE;
      }
      Cycles& all = of_both[at_ours ? 1 : 0];
      all.until_done.insert(all.until_done.end(), found.until_done.begin(), found.until_done.end());
      all.work.insert(all.work.end(), found.work.begin(), found.work.end());
    }
    own.repeats.push_back(figures_of(of_both[0].until_done, 1e-3));
    own_work.repeats.push_back(figures_of(of_both[0].work, 1e-3));
    shared.repeats.push_back(figures_of(of_both[1].until_done, 1e-3));
    shared_work.repeats.push_back(figures_of(of_both[1].work, 1e-3));
  }
  std::printf("A cycle that takes %zu batches, from when it is due, %d cycles, median of %d repeats, %s\n", batches,
              cycles, repeats, realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)");
  for (const Series* series : {&shared, &own, &shared_work, &own_work}) series->print("us");
  shared.print_ratio(own);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 9;
  const int cycles = argc > 2 ? std::atoi(argv[2]) : 20'000;
  return hirosco::bench::run(repeats, cycles);
}
