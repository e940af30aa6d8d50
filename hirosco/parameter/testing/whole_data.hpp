// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/parameter/write_queue.hpp"

/// The load of requirement F11: writers and readers in threads of their own around one cycle, on structures that tell
/// by themselves whether they are whole.
namespace hirosco::testing {

/// 64 octets, each word a function of writer and count: one word of another store makes it invalid.
struct Checked {
  std::uint64_t writer;
  std::uint64_t count;
  std::array<std::uint64_t, 6> mixed;

  static constexpr std::uint64_t mix(std::uint64_t writer, std::uint64_t count, std::uint64_t place) noexcept {
    std::uint64_t x = writer * 0x9E37'79B9'7F4A'7C15 + count * 0xBF58'476D'1CE4'E5B9 + place;
    x ^= x >> 31;
    x *= 0x94D0'49BB'1331'11EB;
    return x ^ x >> 29;
  }
  static constexpr Checked made(std::uint64_t writer, std::uint64_t count) noexcept {
    Checked made{writer, count, {}};
    for (std::size_t i = 0; i < made.mixed.size(); ++i) made.mixed[i] = mix(writer, count, i);
    return made;
  }
  [[nodiscard]] constexpr bool whole() const noexcept {
    for (std::size_t i = 0; i < mixed.size(); ++i)
      if (mixed[i] != mix(writer, count, i)) return false;
    return true;
  }
};

struct WholeDataCount {
  std::uint64_t read{0};     ///< structures that a reader got and checked
  std::uint64_t torn{0};
  std::uint64_t missed{0};   ///< snapshots that gave up because stores were in the way
  std::uint64_t written{0};  ///< structures that the cycle applied or stored
  std::uint64_t refused{0};  ///< batches that found the queue full
  std::uint64_t cycles{0};
};

/// Five writers through the write queue, five readers by native and by encoded snapshot, and the cycle as sixth writer,
/// without a pause, until `structures` were read. The calling thread is the cycle.
[[nodiscard]] inline WholeDataCount run_whole_data_load(std::uint64_t structures) {
  constexpr std::size_t parameters = 6;  // the last one is the cycle's own
  constexpr std::size_t octets = sizeof(Checked);
  std::vector<ParameterSpec> specs;
  for (std::size_t i = 0; i < parameters; ++i)
    specs.push_back({"CHECKED_" + std::to_string(i),
                     {1, Type::Struct, static_cast<std::uint8_t>(i)},
                     {{"WRITER", Type::Uint64, 1}, {"COUNT", Type::Uint64, 1}, {"MIXED", Type::Uint64, 6}},
                     true,
                     {}});
  auto dictionary = std::move(*Dictionary::make(specs));
  std::array<Parameter<Checked>, parameters> cells;
  for (std::size_t i = 0; i < parameters; ++i) {
    cells[i].store(Checked::made(99, i));
    static_cast<void>(dictionary.publish(specs[i].name, cells[i]));
  }
  WriteQueue queue{16, 2 * (octets + 12) + 4};

  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> read{0}, torn{0}, missed{0}, refused{0};
  const auto write = [&](std::uint64_t writer) {
    Parameter<Checked> scratch;
    std::array<std::array<std::byte, octets>, 2> values{};
    for (std::uint64_t count = 0; !stop.load(std::memory_order_relaxed); ++count) {
      for (auto& value : values) {
        scratch.store(Checked::made(writer, count));
        static_cast<void>(scratch.encode(scratch.fields(), value));
      }
      const auto first = static_cast<std::uint16_t>((writer + count) % (parameters - 1));
      const auto second = static_cast<std::uint16_t>((first + 1) % (parameters - 1));
      const std::array<ParameterWrite, 2> batch{{{first, -1, values[0]}, {second, -1, values[1]}}};
      if (!queue.enqueue(dictionary, batch)) {
        refused.fetch_add(1, std::memory_order_relaxed);
        std::this_thread::yield();
      }
    }
  };
  const auto check = [&](std::uint64_t reader) {
    while (!stop.load(std::memory_order_relaxed)) {
      std::uint64_t good = 0, bad = 0, none = 0;
      for (std::uint64_t i = 0; i < 1000; ++i) {
        const std::size_t index = (reader + i) % parameters;
        Checked seen{};
        bool got = false;
        if (i % 2 == 0) {
          got = cells[index].snapshot(seen);
        } else {
          std::array<std::byte, octets> encoded{};
          got = dictionary.snapshot_encode(index, -1, encoded) == octets;
          OctetReader from{encoded};
          seen.writer = from.get<std::uint64_t>();
          seen.count = from.get<std::uint64_t>();
          for (auto& word : seen.mixed) word = from.get<std::uint64_t>();
        }
        if (!got) ++none;
        else if (seen.whole()) ++good;
        else ++bad;
      }
      torn.fetch_add(bad, std::memory_order_relaxed);
      missed.fetch_add(none, std::memory_order_relaxed);
      read.fetch_add(good + bad, std::memory_order_relaxed);
    }
  };

  WholeDataCount result;
  std::vector<std::thread> threads;
  for (std::uint64_t i = 0; i < 5; ++i) {
    threads.emplace_back(write, i);
    threads.emplace_back(check, i);
  }
  while (read.load(std::memory_order_relaxed) < structures) {
    result.written += 2 * queue.apply(dictionary) + 1;
    cells[parameters - 1].store(Checked::made(5, ++result.cycles));
  }
  stop.store(true);
  for (auto& thread : threads) thread.join();
  result.read = read;
  result.torn = torn;
  result.missed = missed;
  result.refused = refused;
  return result;
}

/// The known-wrong twin of Parameter: the same words without the sequence.
class UnsequencedParameter {
 public:
  void store(const Checked& value) noexcept {
    const auto from = std::bit_cast<std::array<std::uint64_t, 8>>(value);
    for (std::size_t i = 0; i < from.size(); ++i) words_[i].store(from[i], std::memory_order_release);
  }
  [[nodiscard]] bool snapshot(Checked& value) const noexcept {
    std::array<std::uint64_t, 8> to{};
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = words_[i].load(std::memory_order_acquire);
    value = std::bit_cast<Checked>(to);
    return true;
  }

 private:
  std::array<std::atomic<std::uint64_t>, 8> words_{};
};

/// Stores in one thread and reads in another until a torn structure was read or `most` were read.
template <class Cell>
[[nodiscard]] std::uint64_t torn_of(std::uint64_t most) {
  const auto cell = std::make_unique<Cell>();
  cell->store(Checked::made(0, 0));
  std::atomic<bool> stop{false};
  std::thread writer{[&] {
    for (std::uint64_t count = 1; !stop.load(std::memory_order_relaxed); ++count) cell->store(Checked::made(0, count));
  }};
  std::uint64_t torn = 0;
  for (std::uint64_t i = 0; i < most && torn == 0; ++i) {
    Checked seen{};
    if (cell->snapshot(seen) && !seen.whole()) ++torn;
  }
  stop.store(true);
  writer.join();
  return torn;
}

}  // namespace hirosco::testing
