// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Round trip between two processes: 256 octets by LatestWriter and LatestReader, against the barest sequence lock of the same octets and one
// word on a bare cache line.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

constexpr std::uint32_t payload_octets = 256;
constexpr int warm_up_rounds = 2'000;
constexpr LinkLayout layout{1, payload_octets, 1, 500us};

/// What a sequence lock costs that has no status, no stamp, no account, no proof and no end: who waits spins for ever. Its copies are plain ones,
/// which the language calls a race; it is the limit of the machine and no part of a craft.
struct RawLock {
  alignas(64) std::uint64_t sequence{0};
  alignas(64) std::array<std::byte, payload_octets> payload;

  void write(const std::byte* from, std::uint64_t number) {
    const std::atomic_ref counted{sequence};
    counted.store(2 * number - 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    std::memcpy(payload.data(), from, payload_octets);
    counted.store(2 * number, std::memory_order_release);
  }
  void await(std::byte* to, std::uint64_t number) {
    const std::atomic_ref counted{sequence};
    for (;;) {
      if (counted.load(std::memory_order_acquire) != 2 * number) continue;
      std::memcpy(to, payload.data(), payload_octets);
      std::atomic_thread_fence(std::memory_order_acquire);
      if (counted.load(std::memory_order_relaxed) == 2 * number) return;
    }
  }
};

/// What both processes see.
struct Arena {
  SealedMemory provider;
  Mapping lines = provider.map(provider.create("lines", 4096).value(), Access::ReadWrite).value();
  Mapping there =
      provider.map(provider.create("there", link_memory_octets(payload_octets)).value(), Access::ReadWrite).value();
  Mapping back =
      provider.map(provider.create("back", link_memory_octets(payload_octets)).value(), Access::ReadWrite).value();

  std::atomic_ref<std::uint64_t> line(std::size_t number) {
    return std::atomic_ref{*reinterpret_cast<std::uint64_t*>(lines.octets.data() + number * 128)};
  }
  RawLock& lock(std::size_t number) { return *reinterpret_cast<RawLock*>(lines.octets.data() + 1024 + number * 1024); }
};

/// One end of both contests; the first end starts each round, the second one answers.
class End {
 public:
  End(Arena& arena, bool first) : arena_{arena}, out_{first ? 0U : 1U}, in_{first ? 1U : 0U} {
    writer_ = LatestWriter::make((first ? arena.there : arena.back).octets, layout).value();
  }
  void connect() {
    reader_.emplace(LatestReader::make((in_ == 1 ? arena_.back : arena_.there).octets, layout).value());
  }

  void send_line(std::uint64_t value) { arena_.line(out_).store(value, std::memory_order_release); }
  void await_line(std::uint64_t value) {
    while (arena_.line(in_).load(std::memory_order_acquire) != value) {}
  }
  void send_lock(std::uint64_t value) { arena_.lock(out_).write(payload_.data(), value); }
  void await_lock(std::uint64_t value) { arena_.lock(in_).await(payload_.data(), value); }
  void send_link(TimePoint now) { writer_.write(payload_, now, LinkStatus::Valid); }
  /// By the word that a consumer waits for, as the lock's: what a cycle asks for it has without waiting.
  void await_link() {
    const std::atomic_ref arrived{*const_cast<std::uint32_t*>(reader_->arrival_word())};
    for (;;) {
      const std::uint32_t now = arrived.load(std::memory_order_acquire);
      if (now == arrived_ || now % 2 != 0) continue;
      if (reader_->read(payload_).flow != Flow::New) continue;
      arrived_ = now;
      return;
    }
  }

 private:
  Arena& arena_;
  std::size_t out_;
  std::size_t in_;
  LatestWriter writer_;
  std::optional<LatestReader> reader_;
  std::uint32_t arrived_{0};
  std::array<std::byte, payload_octets> payload_{};
};

bool settle(unsigned cpu) {
  (void)lock_memory();
  (void)pin_to_cpu(cpu);
  return set_fifo_priority(50).has_value();
}

void answer(End& end, int repeats, int rounds) {
  std::uint64_t value = 0, locked = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (int i = 0; i < rounds + warm_up_rounds; ++i) {
      end.await_line(++value);
      end.send_line(value);
    }
    for (int i = 0; i < rounds + warm_up_rounds; ++i) {
      end.await_lock(++locked);
      end.send_lock(locked);
    }
    for (int i = 0; i < rounds + warm_up_rounds; ++i) {
      end.await_link();
      end.send_link({});
    }
  }
}

template <class Round>
Figures measure(const Clock& clock, int rounds, Round&& round) {
  std::vector<std::int64_t> samples;
  samples.reserve(static_cast<std::size_t>(rounds));
  for (int i = 0; i < warm_up_rounds; ++i) round();
  for (int i = 0; i < rounds; ++i) {
    const TimePoint start = clock.now();
    round();
    samples.push_back((clock.now() - start).count());
  }
  return figures_of(samples, 1.0);
}

int run(int repeats, int rounds) {
  const SystemClock clock;
  Arena arena;
  End end{arena, true};
  End other{arena, false};
  end.connect();
  other.connect();
  const pid_t child = ::fork();
  if (child < 0) return EXIT_FAILURE;
  if (child == 0) {
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
    (void)settle(1);
    answer(other, repeats, rounds);
    ::_exit(EXIT_SUCCESS);
  }
  const bool realtime = settle(0);
  Series line{"bare line", {}};
  Series raw{"raw sequence lock, 256 B", {}};
  Series link{"link, 256 B", {}};
  std::uint64_t value = 0, locked = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    line.repeats.push_back(measure(clock, rounds, [&] {
      end.send_line(++value);
      end.await_line(value);
    }));
    raw.repeats.push_back(measure(clock, rounds, [&] {
      end.send_lock(++locked);
      end.await_lock(locked);
    }));
    link.repeats.push_back(measure(clock, rounds, [&] {
      end.send_link({});
      end.await_link();
    }));
  }
  (void)::waitpid(child, nullptr, 0);
  std::printf("Round trip between two processes, %d rounds, median of %d repeats, %s\n", rounds, repeats,
              realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)");
  line.print("ns");
  raw.print("ns");
  link.print("ns");
  link.print_ratio(line);
  link.print_ratio(raw);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 9;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 100'000;
  return hirosco::bench::run(repeats, rounds);
}
