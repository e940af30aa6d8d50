// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>

/// Makes any thread of a program spin for ever when it is sent SIGUSR2: a cycle that loops, at its own priority, in the
/// real subsystem. Linked beside its main() for tests only.
namespace {

volatile unsigned long rounds = 0;

struct Spinnable {
  Spinnable() {
    struct sigaction action{};
    action.sa_handler = [](int) {
      for (;;) rounds = rounds + 1;
    };
    ::sigaction(SIGUSR2, &action, nullptr);
  }
} const spinnable;

}  // namespace
