// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstring>

/// A real subsystem that harms whom it can when it is told to: SIGUSR1: it allocates until it is refused and goes on touching what
/// it got; SIGUSR2 to a thread of it: that spins at the priority that it has; SIGRTMIN: it writes over all that it may write, again
/// and again. Linked beside its main() for tests only.
namespace {

volatile unsigned long rounds = 0;

int next() {
  rounds = rounds + 1;
  return static_cast<int>(rounds);
}

void spin(int) {
  for (;;) next();
}

[[noreturn]] void allocate_to_refusal() {
  constexpr std::size_t piece = 1 << 20;
  constexpr std::size_t page = 4096;
  std::array<char*, 4096> pieces{};
  for (std::size_t used = 0;;) {
    if (used < pieces.size()) {
      void* const at = ::mmap(nullptr, piece, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (at != MAP_FAILED) pieces[used++] = static_cast<char*>(at);
    }
    for (std::size_t i = 0; i < used; ++i)
      for (std::size_t octet = 0; octet < piece; octet += page) pieces[i][octet] = static_cast<char>(next());
  }
}

/// The mappings that it shares with others and may write.
void write_over_everything() {
  struct Region {
    std::uintptr_t begin, end;
  };
  std::array<Region, 64> found{};
  std::size_t count = 0;
  std::FILE* const maps = std::fopen("/proc/self/maps", "re");
  std::array<char, 512> line;
  while (maps != nullptr && count < found.size() && std::fgets(line.data(), line.size(), maps) != nullptr) {
    std::array<char, 5> access{};
    Region region{};
    if (std::sscanf(line.data(), "%" SCNxPTR "-%" SCNxPTR " %4s", &region.begin, &region.end, access.data()) == 3 &&
        std::strcmp(access.data(), "rw-s") == 0)
      found[count++] = region;
  }
  for (;;)
    for (std::size_t i = 0; i < count; ++i)
      std::memset(reinterpret_cast<void*>(found[i].begin), next(), found[i].end - found[i].begin);
}

void* turn(void*) {
  sigset_t wanted;
  sigemptyset(&wanted);
  sigaddset(&wanted, SIGUSR1);
  sigaddset(&wanted, SIGRTMIN);
  int number = 0;
  ::sigwait(&wanted, &number);
  if (number == SIGUSR1) allocate_to_refusal();
  write_over_everything();
  return nullptr;
}

struct Rogue {
  Rogue() {
    struct sigaction action{};
    action.sa_handler = spin;
    ::sigaction(SIGUSR2, &action, nullptr);
    // Blocked before there is another thread: the one that waits for them gets them.
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGUSR1);
    sigaddset(&set, SIGRTMIN);
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
    pthread_t thread;
    ::pthread_create(&thread, nullptr, turn, nullptr);
  }
} const rogue;

}  // namespace
