// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// What a block costs that is taken from pools and given back, against the barest free list of the same octets in the same run.
#include <array>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/resource/block_pools.hpp"
#include "hirosco/utilities/os/clock.hpp"

namespace hirosco::bench {
namespace {

constexpr std::size_t block_octets = 256, blocks = 1024, held = 64, pairs = 2'000'000;
constexpr int repeats = 15;

/// Knows no size, no use, no foreign block and no end.
class RawFreeList {
 public:
  RawFreeList() : memory_(block_octets * blocks) {
    for (std::size_t i = 0; i < blocks; ++i) give_back(memory_.data() + i * block_octets);
  }
  [[gnu::noinline]] void* take() noexcept {
    Link* const link = first_;
    first_ = link->next;
    return link;
  }
  [[gnu::noinline]] void give_back(void* block) noexcept { first_ = ::new (block) Link{first_}; }

 private:
  struct Link {
    Link* next;
  };
  std::vector<std::byte> memory_;
  Link* first_{nullptr};
};

/// Nanoseconds for one block taken, written to and given back, 64 of them held all the time.
template <class Take, class GiveBack>
double pair_ns(const Clock& clock, Take take, GiveBack give_back) {
  std::array<void*, held> kept{};
  for (void*& block : kept) block = take();
  const TimePoint begin = clock.now();
  for (std::size_t i = 0; i < pairs; ++i) {
    void*& block = kept[i % held];
    give_back(block);
    block = take();
    std::memcpy(block, &i, sizeof i);
  }
  const Duration spent = clock.now() - begin;
  for (void* block : kept) give_back(block);
  return static_cast<double>(spent.count()) / static_cast<double>(pairs);
}

int run() {
  const SystemClock clock;
  const std::array specs{PoolSpec{64, blocks}, PoolSpec{block_octets, blocks}, PoolSpec{1024, blocks}};
  const auto local = LocalBlockPools::create(specs);
  const auto shared = BlockPools::create(specs);
  if (!local || !shared) return 1;
  RawFreeList raw;
  Series of_raw{"raw free list", {}}, of_local{"pools of one thread", {}}, of_shared{"pools of any thread", {}};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto note = [](Series& series, double ns) { series.repeats.push_back({ns, ns, ns, ns}); };
    note(of_raw, pair_ns(clock, [&] { return raw.take(); }, [&](void* block) { raw.give_back(block); }));
    note(of_local, pair_ns(clock, [&] { return (*local)->allocate(200); }, [&](void* b) { (*local)->deallocate(b); }));
    note(of_shared,
         pair_ns(clock, [&] { return (*shared)->allocate(200); }, [&](void* b) { (*shared)->deallocate(b); }));
  }
  std::printf("A block taken, written to and given back, medians of %d\n", repeats);
  for (const Series* series : {&of_raw, &of_local, &of_shared})
    std::printf("%-22s %7.2f ns   %5.2f x\n", series->name, series->middle(&Figures::p50),
                series->ratio_to(of_raw, &Figures::p50));
  return 0;
}

}  // namespace
}  // namespace hirosco::bench

int main() { return hirosco::bench::run(); }
