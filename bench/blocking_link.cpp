// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// From the instant at which a producer has a sample to the one at which its consumer, which slept, has read it: two processes on one
// processor, by a link that wakes and by a bare futex, in turns in the same run.
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/word_wait.hpp"

namespace hirosco::bench {
namespace {

constexpr std::uint32_t payload_octets = 256;
constexpr std::size_t max_samples = 100'000;
constexpr Duration pace = std::chrono::microseconds{200};
constexpr int producers_priority = 51,
              consumers_priority = 50;  // its cycle comes when the producer's is over (adr 0007)

/// What the consumer found, and the bare contestant's word.
struct Shared {
  alignas(64) std::atomic<std::uint32_t> word{0};
  std::atomic<std::int64_t> stamp{0};
  alignas(64) std::atomic<std::uint32_t> ready{0};
  std::atomic<std::uint32_t> got{0};  ///< of the samples: one that came too late for the next is nobody's
  std::array<std::int64_t, max_samples> waited{};
};

Shared* shared_object() {
  void* const memory =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  return memory == MAP_FAILED ? nullptr : new (memory) Shared;
}

long futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value) {
  return ::syscall(SYS_futex, &word, operation, value, nullptr, nullptr, 0);
}

/// The consumer in a process of its own; how long each sample was on its way.
template <class Consume, class Produce>
Figures between_processes(Shared& shared, int samples, Consume consume, Produce produce) {
  const SystemClock clock;
  shared.ready = 0;
  shared.got = 0;
  const pid_t child = ::fork();
  if (child < 0) std::exit(EXIT_FAILURE);
  if (child == 0) {
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
    (void)pin_to_cpu(0);
    (void)set_fifo_priority(consumers_priority);
    consume();
    ::_exit(0);
  }
  while (shared.ready.load() == 0) {
    if (::waitpid(child, nullptr, WNOHANG) == child) std::exit(EXIT_FAILURE);
    sleep_until(clock.now() + pace);
  }
  TimePoint next = clock.now() + 10 * pace;
  for (int number = 0; number < samples; ++number, next += pace) {
    sleep_until(next);
    produce(clock.now());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (shared.got.load() == 0) std::exit(EXIT_FAILURE);  // nothing arrived: that is no figure
  std::vector<std::int64_t> waited(shared.waited.begin(), shared.waited.begin() + shared.got.load());
  return figures_of(waited, 1e-3);
}

Figures by_link(Shared& shared, LinkKind kind, int samples) {
  SealedMemory provider;
  const LinkLayout layout{.epoch = 1,
                          .payload_octets = payload_octets,
                          .layout_hash = 1,
                          .period = pace,
                          .depth = kind == LinkKind::Queued ? default_link_depth : 0,
                          .wakes = true};
  const LinkMechanism& mechanism = *find_link_mechanism(standard_link_mechanisms(), LinkMethod::SharedMemory, kind);
  const MemoryHandle memory = mechanism.establish(provider, layout).value();
  const auto writer = mechanism.produce(provider, memory, layout).value();
  std::array<std::byte, payload_octets> payload{};
  return between_processes(
      shared, samples,
      [&] {
        const SystemClock clock;
        const auto reader = mechanism.consume(provider, memory, layout).value();
        std::array<std::byte, payload_octets> seen{};
        shared.ready = 1;
        for (std::uint64_t count = 0, got = 0; count < static_cast<std::uint64_t>(samples);) {
          const std::uint32_t before =
              std::atomic_ref<std::uint32_t>{const_cast<std::uint32_t&>(*reader->arrival_word())}.load();
          const LinkSample sample = reader->read(seen);
          if (sample.flow == Flow::New) {
            shared.waited[got++] = (clock.now() - sample.sampled_at).count();
            shared.got = static_cast<std::uint32_t>(got);
            count = sample.count;
            continue;  // of a queue there may be more
          }
          (void)wait_on_word(*reader->arrival_word(), before, TimePoint::max());
        }
      },
      [&](TimePoint now) { writer->write(payload, now, LinkStatus::Valid); });
}

/// What it costs at least: a word, and a wait on it.
Figures by_futex(Shared& shared, int samples) {
  shared.word = 0;
  return between_processes(
      shared, samples,
      [&] {
        const SystemClock clock;
        shared.ready = 1;
        for (std::uint32_t count = 0, got = 0; count < static_cast<std::uint32_t>(samples);) {
          while (shared.word.load(std::memory_order_acquire) == count) (void)futex(shared.word, FUTEX_WAIT, count);
          shared.waited[got++] = clock.now().time_since_epoch().count() - shared.stamp.load(std::memory_order_relaxed);
          shared.got = got;
          count = shared.word.load(std::memory_order_relaxed);
        }
      },
      [&](TimePoint now) {
        shared.stamp.store(now.time_since_epoch().count(), std::memory_order_relaxed);
        shared.word.fetch_add(1, std::memory_order_release);
        (void)futex(shared.word, FUTEX_WAKE, static_cast<std::uint32_t>(std::numeric_limits<int>::max()));
      });
}

int run(int repeats, int samples) {
  Shared* const shared = shared_object();
  if (shared == nullptr || samples < 1 || static_cast<std::size_t>(samples) > max_samples) return EXIT_FAILURE;
  (void)lock_memory();
  (void)pin_to_cpu(0);
  const bool realtime = set_fifo_priority(producers_priority).has_value();
  Series latest{"latest link, woken", {}}, queued{"queued link, woken", {}}, bare{"raw futex", {}};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    latest.repeats.push_back(by_link(*shared, LinkKind::Latest, samples));
    bare.repeats.push_back(by_futex(*shared, samples));
    queued.repeats.push_back(by_link(*shared, LinkKind::Queued, samples));
  }
  std::printf("Blocking link, %u octets, two processes on one processor, %d samples, median of %d repeats, %s\n",
              payload_octets, samples, repeats, realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)");
  latest.print("us");
  queued.print("us");
  bare.print("us");
  latest.print_ratio(bare);
  queued.print_ratio(bare);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 9;
  const int samples = argc > 2 ? std::atoi(argv[2]) : 5'000;
  return hirosco::bench::run(repeats, samples);
}
