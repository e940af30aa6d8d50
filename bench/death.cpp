// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// From kill -9 until every other member of its network is fenced on the page that its cycle reads: guard and LifeWatch as they fly, the victim small and
// with 512 MB, beside a bare thread that sleeps on one word that the system marks.
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/life.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/guard/life_watch.hpp"

namespace hirosco::bench {
namespace {

using supervisor::Guard;
using supervisor::LaunchedSubsystem;
using supervisor::LifeWatch;

constexpr std::uint16_t first_apid = 10;
constexpr std::uint16_t members = 8;  ///< one of them dies
constexpr std::size_t large_octets = std::size_t{512} << 20;
constexpr std::size_t page_octets = 4096;

/// Written by the victim the moment before it kills itself.
struct Shared {
  VitalPage vital;
  std::atomic<std::int64_t> killed_ns{0};
};

[[nodiscard]] Shared* shared_page() {
  void* const memory =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  return memory == MAP_FAILED ? nullptr : new (memory) Shared;
}

[[nodiscard]] pid_t start_victim(Shared& shared, std::size_t octets) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  static_cast<void>(::prctl(PR_SET_PDEATHSIG, SIGKILL));
  static_cast<void>(pin_to_cpu(1));
  if (octets != 0) {
    auto* const memory =
        static_cast<std::byte*>(::mmap(nullptr, octets, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    if (memory == MAP_FAILED) ::_exit(EXIT_FAILURE);
    for (std::size_t at = 0; at < octets; at += page_octets) memory[at] = std::byte{1};
  }
  if (!hold_life(shared.vital.life)) ::_exit(EXIT_FAILURE);
  // The watcher sleeps by then, as it does in a flight.
  ::usleep(20'000);
  shared.killed_ns.store(SystemClock{}.now().time_since_epoch().count());
  ::kill(::getpid(), SIGKILL);
  for (;;) ::pause();
}

/// Who is woken by the mark of the system and does nothing else. That is seen by who looks between the sleeps, as the fences of a network are below:
/// neither watcher wakes a processor that has gone to rest.
[[nodiscard]] std::int64_t raw(const Clock& clock, std::size_t octets) {
  auto* const shared = shared_page();
  std::atomic<bool> seen{false};
  std::atomic<std::uint32_t> over{0};
  const pid_t victim = start_victim(*shared, octets);
  auto sleeper = Thread::start("sleeper", [&] {
    static_cast<void>(pin_to_cpu(0));
    static_cast<void>(set_fifo_priority(LifeWatch::priority));
    for (std::uint32_t word = shared->vital.life.load(); life_of(word) != Life::Ended; word = shared->vital.life.load())
      static_cast<void>(wait_for_change(std::array{SeenWord{&shared->vital.life, word}}, std::chrono::seconds{10}));
    seen.store(true, std::memory_order_release);
    // It sleeps again, as a watcher does: its end would be in the figure.
    while (over.load() == 0)
      static_cast<void>(wait_for_change(std::array{SeenWord{&over, 0}}, std::chrono::seconds{10}));
  });
  if (!sleeper) std::exit(EXIT_FAILURE);
  while (!seen.load(std::memory_order_acquire)) {}
  const std::int64_t took = clock.now().time_since_epoch().count() - shared->killed_ns.load();
  over.store(1);
  wake_waiters(over);
  sleeper->join();
  ::waitpid(victim, nullptr, 0);
  ::munmap(shared, sizeof(Shared));
  return took;
}

/// A guard that holds a network of eight, all of them Operational.
class Network {
 public:
  explicit Network(const Clock& clock) : clock_{clock}, guard_{{.clock = clock, .flows = flows_, .on_finding = {}}} {
    described_.resize(members);
    vital_.resize(members);
    permit_.resize(members);
    for (std::uint16_t i = 0; i < members; ++i) {
      described_[i].subsystem.id = first_apid + i;
      described_[i].subsystem.name = "MEMBER" + std::to_string(i);
      static_cast<void>(guard_.add(described_[i], false));
    }
  }
  [[nodiscard]] std::int64_t victim_dies(std::size_t octets) {
    auto* const shared = shared_page();
    std::vector<std::uint16_t> all;
    for (std::uint16_t i = 0; i < members; ++i) {
      adopt(i, i == 0 ? &shared->vital : nullptr);
      all.push_back(first_apid + i);
    }
    guard_.falls_with(first_apid, all);
    const pid_t victim = start_victim(*shared, octets);
    while (moves()) {}
    const std::int64_t took = clock_.now().time_since_epoch().count() - shared->killed_ns.load();
    ::waitpid(victim, nullptr, 0);
    for (std::uint16_t i = 0; i < members; ++i) guard_.forget(first_apid + i);
    ::munmap(shared, sizeof(Shared));
    return took;
  }
  [[nodiscard]] Guard& guard() noexcept { return guard_; }

 private:
  void adopt(std::uint16_t number, VitalPage* page) {
    LaunchedSubsystem launched;
    vital_[number] = memory_.map(memory_.create("vital", sizeof(VitalPage)).value(), Access::ReadWrite).value();
    permit_[number] = memory_.map(memory_.create("permit", sizeof(PermitPage)).value(), Access::ReadWrite).value();
    auto* const vital = page != nullptr ? page : new (vital_[number].octets.data()) VitalPage{};
    new (permit_[number].octets.data()) PermitPage{};
    vital->state = static_cast<std::uint32_t>(State::Operational);
    launched.vital =
        page != nullptr ? Mapping{nullptr, {reinterpret_cast<std::byte*>(page), sizeof(VitalPage)}} : vital_[number];
    launched.permit = permit_[number];
    guard_.started(first_apid + number, launched);
    static_cast<void>(guard_.release(first_apid + number, guard_.fences(first_apid + number)));
  }
  /// One of them at least.
  [[nodiscard]] bool moves() const {
    for (std::uint16_t i = 0; i < members; ++i) {
      const auto& page = *reinterpret_cast<const PermitPage*>(permit_[i].octets.data());
      if (page.go.load(std::memory_order_acquire) != 0) return true;
    }
    return false;
  }

  const Clock& clock_;
  LocalFlows flows_;
  HeapMemory memory_;
  std::vector<descriptor::MissionSubsystem> described_;
  std::vector<Mapping> vital_, permit_;
  Guard guard_;
};

int run(int repeats, int kills) {
  const SystemClock clock;
  // Of the watchers, too, which begin here: a processor of its own would be one too many, it looks between their sleeps, as they are above it.
  static_cast<void>(pin_to_cpu(0));
  Network network{clock};
  const auto watch = LifeWatch::start(network.guard());
  if (!watch) {
    std::fprintf(stderr, "The end of a process: %s\n", watch.error().text);
    return EXIT_FAILURE;
  }
  std::array<Series, 2> bare{Series{"bare word, small", {}}, Series{"bare word, 512 MB", {}}};
  std::array<Series, 2> ours{Series{"network fenced, small", {}}, Series{"network fenced, 512 MB", {}}};
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t size = 0; size < 2; ++size) {
      std::vector<std::int64_t> of_bare, of_ours;
      for (int i = 0; i < kills; ++i) {
        of_bare.push_back(raw(clock, size == 0 ? 0 : large_octets));
        of_ours.push_back(network.victim_dies(size == 0 ? 0 : large_octets));
      }
      bare[size].repeats.push_back(figures_of(of_bare, 1e-3));
      ours[size].repeats.push_back(figures_of(of_ours, 1e-3));
    }
  std::printf("From kill -9 until all %d members of its network are fenced, %d kills, median of %d repeats\n",
              static_cast<int>(members), kills, repeats);
  for (std::size_t size = 0; size < 2; ++size) {
    bare[size].print("us");
    ours[size].print("us");
    ours[size].print_ratio(bare[size]);
  }
  std::printf("512 MB / small: bare %.2f, network %.2f (p50)\n", bare[1].ratio_to(bare[0], &Figures::p50),
              ours[1].ratio_to(ours[0], &Figures::p50));
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 9;
  const int kills = argc > 2 ? std::atoi(argv[2]) : 10;
  return hirosco::bench::run(repeats, kills);
}
