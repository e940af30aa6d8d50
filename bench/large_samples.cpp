// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// An image of 1 MiB, 30 a second: what a link that lends takes of producer and consumer together, against one that copies.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/data_transfer/link/loaned_link.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

constexpr std::uint32_t payload_octets = 1U << 20;
constexpr Duration period = std::chrono::nanoseconds{1'000'000'000 / 30};
constexpr LinkLayout layout{1, payload_octets, 1, period};

/// Both ends of a link in two mappings of its memory, as two processes have them.
struct Lent {
  SealedMemory provider;
  LoanedLink mechanism;
  MemoryHandle shared = mechanism.establish(provider, layout).value();
  std::unique_ptr<LoanWriter> writer = mechanism.lend(provider, shared, layout).value();
  std::unique_ptr<LoanReader> reader = mechanism.borrow(provider, shared, layout).value();
};
struct Copied {
  SealedMemory provider;
  LoanedLink mechanism;
  MemoryHandle shared = mechanism.establish(provider, layout).value();
  std::unique_ptr<LinkWriter> writer = mechanism.produce(provider, shared, layout).value();
  std::unique_ptr<LinkReader> reader = mechanism.consume(provider, shared, layout).value();
  std::vector<std::byte> made = std::vector<std::byte>(payload_octets);
  std::vector<std::byte> seen = std::vector<std::byte>(payload_octets);
};

/// What the author does with an image is no part of the figures.
void make(MutableOctets image, int number) { std::memset(image.data(), number, image.size()); }
bool is(Octets image, int number) {
  return image.front() == static_cast<std::byte>(number) && image.back() == static_cast<std::byte>(number);
}

int run(int repeats, int rounds) {
  const SystemClock clock;
  Lent lent;
  Copied copied;
  (void)lock_memory();
  (void)pin_to_cpu(0);
  const bool realtime = set_fifo_priority(50).has_value();
  Series lends{"lent, 1 MiB", {}};
  Series copies{"copied, 1 MiB", {}};
  TimePoint next = clock.now();
  bool right = true;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::vector<std::int64_t> by_lending, by_copying;
    for (int i = 0; i < rounds; ++i) {
      next += period;
      sleep_until(next);
      const TimePoint asked = clock.now();
      const MutableOctets place = lent.writer->lend();
      const TimePoint given = clock.now();
      make(place, i);
      make(copied.made, i);
      const TimePoint made = clock.now();
      lent.writer->publish(made, LinkStatus::Valid);
      const bool found = lent.reader->newest().flow == Flow::New;
      const Octets seen = lent.reader->look();
      const bool whole = lent.reader->whole();
      const TimePoint looked = clock.now();
      copied.writer->write(copied.made, looked, LinkStatus::Valid);
      const bool read = copied.reader->read(copied.seen).flow == Flow::New;
      const TimePoint done = clock.now();
      by_lending.push_back(((given - asked) + (looked - made)).count());
      by_copying.push_back((done - looked).count());
      right = right && found && whole && read && is(seen, i) && is(copied.seen, i);
    }
    lends.repeats.push_back(figures_of(by_lending, 1.0));
    copies.repeats.push_back(figures_of(by_copying, 1.0));
  }
  if (!right) return EXIT_FAILURE;
  std::printf("Images of 1 MiB, 30 a second, %d a repeat, median of %d repeats, %s\n", rounds, repeats,
              realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)");
  lends.print("ns");
  copies.print("ns");
  lends.print_ratio(copies);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 5;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 60;
  return hirosco::bench::run(repeats, rounds);
}
