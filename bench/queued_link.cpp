// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Samples a second through a queued link between two processes, against a bare ring of the same octets in the same run.
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/data_transfer/link/queued_link.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

constexpr std::uint32_t payload_octets = 64;
constexpr std::uint32_t depth = 1024;
constexpr LinkLayout layout{1, payload_octets, 1, std::chrono::milliseconds{1}, depth};
using Payload = std::array<std::byte, payload_octets>;

/// Between two processes that run by themselves: how far each is, and when it was done.
struct Shared {
  alignas(64) std::atomic<std::uint64_t> taken{0};  ///< by the consumer, samples; both contestants wait by it alike
  alignas(64) std::atomic<std::uint32_t> ready{0};
  std::atomic<std::int64_t> done_ns{0};
  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> lost{0};
};

/// What a ring costs that has no header, no status, no account and no proof: sample, then count.
struct BareRing {
  alignas(64) std::atomic<std::uint64_t> written{0};
  alignas(64) std::array<Payload, depth> slots;
};

template <class T>
T* shared_object() {
  void* const memory =
      ::mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  return memory == MAP_FAILED ? nullptr : new (memory) T;
}

/// So that none is lost and both do the same work, the producer stays within half a ring: it looks at every 64th sample only.
void wait_for_room(const Shared& shared, std::uint64_t number) {
  if (number % 64 != 0) return;
  while (number > shared.taken.load(std::memory_order_acquire) + depth / 2) {}
}

/// Runs the consumer in a process of its own; nanoseconds from the first sample written to the last one read.
template <class Consume, class Produce>
std::int64_t between_processes(Shared& shared, Consume consume, Produce produce) {
  const SystemClock clock;
  shared.taken = 0;
  shared.ready = 0;
  shared.received = shared.lost = 0;
  const pid_t child = ::fork();
  if (child < 0) std::exit(EXIT_FAILURE);
  if (child == 0) {
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it spins above all others
    (void)pin_to_cpu(1);
    (void)set_fifo_priority(50);
    consume();
    shared.done_ns = clock.now().time_since_epoch().count();
    ::_exit(0);
  }
  while (shared.ready.load() == 0)
    if (::waitpid(child, nullptr, WNOHANG) == child) std::exit(EXIT_FAILURE);
  const std::int64_t begun = clock.now().time_since_epoch().count();
  produce();
  int status = 0;
  ::waitpid(child, &status, 0);
  return shared.done_ns.load() - begun;
}

std::int64_t by_link(Shared& shared, std::uint64_t samples) {
  SealedMemory provider;
  const QueuedLink mechanism;
  const MemoryHandle memory = mechanism.establish(provider, layout).value();
  const auto writer = mechanism.produce(provider, memory, layout).value();
  return between_processes(
      shared,
      [&] {
        const auto reader = mechanism.consume(provider, memory, layout).value();
        Payload seen{};
        std::uint64_t received = 0, lost = 0;
        shared.ready = 1;
        for (std::uint64_t count = 0; count < samples;) {
          const LinkSample sample = reader->read(seen);
          if (sample.flow != Flow::New) continue;
          ++received;
          lost += sample.lost;
          count = sample.count;
          if (count % 64 == 0) shared.taken.store(count, std::memory_order_release);
        }
        shared.received = received;
        shared.lost = lost;
      },
      [&] {
        Payload payload{};
        for (std::uint64_t number = 1; number <= samples; ++number) {
          wait_for_room(shared, number);
          std::memcpy(payload.data(), &number, sizeof number);
          writer->write(payload, TimePoint{}, LinkStatus::Valid);
        }
      });
}

std::int64_t by_bare_ring(Shared& shared, BareRing& ring, std::uint64_t samples) {
  ring.written = 0;
  return between_processes(
      shared,
      [&] {
        Payload seen{};
        shared.ready = 1;
        for (std::uint64_t count = 0; count < samples;) {
          if (ring.written.load(std::memory_order_acquire) == count) continue;
          ++count;
          std::memcpy(&seen, &ring.slots[count % depth], sizeof seen);
          asm volatile("" : : "r"(&seen) : "memory");  // it is read, though nobody looks
          if (count % 64 == 0) shared.taken.store(count, std::memory_order_release);
        }
      },
      [&] {
        Payload payload{};
        for (std::uint64_t number = 1; number <= samples; ++number) {
          wait_for_room(shared, number);
          std::memcpy(payload.data(), &number, sizeof number);
          ring.slots[number % depth] = payload;
          ring.written.store(number, std::memory_order_release);
        }
      });
}

int run(int repeats, std::uint64_t samples) {
  auto* const shared = shared_object<Shared>();
  auto* const ring = shared_object<BareRing>();
  if (shared == nullptr || ring == nullptr) return EXIT_FAILURE;
  (void)lock_memory();
  (void)pin_to_cpu(0);
  const bool realtime = set_fifo_priority(50).has_value();
  std::vector<double> link, bare, ratios;
  std::uint64_t lost = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto per_second = [samples](std::int64_t ns) {
      return static_cast<double>(samples) / static_cast<double>(ns) * 1e9;
    };
    link.push_back(per_second(by_link(*shared, samples)));
    if (shared->received.load() + shared->lost.load() != samples) return EXIT_FAILURE;
    lost += shared->lost.load();
    bare.push_back(per_second(by_bare_ring(*shared, *ring, samples)));
    ratios.push_back(link.back() / bare.back());
  }
  std::printf("Queued link, %u octets, %u deep, two processes, %llu samples a repeat, median of %d repeats, %s\n",
              payload_octets, depth, static_cast<unsigned long long>(samples), repeats,
              realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)");
  std::printf("%-28s %12.0f samples/s, %llu lost\n", "queued link", median(link),
              static_cast<unsigned long long>(lost));
  std::printf("%-28s %12.0f samples/s\n", "bare ring", median(bare));
  std::printf("%-28s %12.2f\n", "queued link / bare ring", median(ratios));
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 7;
  const auto samples = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 2'000'000);
  return hirosco::bench::run(repeats, samples);
}
