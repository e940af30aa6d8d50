// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/resource.h>
#include <time.h>

#include <cstddef>
#include <cstdlib>

/// Makes a program leak from when it is sent SIGUSR2 on, 64 kB in each millisecond in pieces of every size, until the limit that somebody has
/// set it (RLIMIT_AS) leaves nothing to leak, and then whatever becomes free. Linked beside its main() for tests only.
namespace {

constexpr std::size_t octets_a_round = std::size_t{64} << 10, smallest = 32;

sem_t begun;
void* volatile newest = nullptr;

void leak_a_round() {
  std::size_t left = octets_a_round;
  for (std::size_t size = octets_a_round; size >= smallest; size /= 2)
    while (left >= size) {
      auto* const piece = static_cast<void**>(std::malloc(size));
      if (piece == nullptr) break;
      *piece = newest;
      newest = piece;
      left -= size;
    }
}

void* leak(void*) {
  while (::sem_wait(&begun) != 0) {}
  rlimit limit{};
  // Without one it would be this computer's memory.
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return nullptr;
  for (;;) {
    leak_a_round();
    const timespec pause{0, 1'000'000};
    ::nanosleep(&pause, nullptr);
  }
}

struct Leaking {
  Leaking() {
    ::sem_init(&begun, 0, 0);
    struct sigaction action{};
    action.sa_handler = [](int) { ::sem_post(&begun); };
    ::sigaction(SIGUSR2, &action, nullptr);
    // What the program waits for as signals is not for this thread.
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    pthread_t thread{};
    ::pthread_create(&thread, nullptr, leak, nullptr);
    ::pthread_detach(thread);
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
} const leaking;

}  // namespace
