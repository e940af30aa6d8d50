// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/keeper.hpp"

#include <fcntl.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "hirosco/utilities/os/clock.hpp"

namespace hirosco::supervisor {
namespace {

constexpr int exit_environment = 3;
constexpr int exit_internal = 4;
constexpr Duration device_grace = 1s;
/// A terminal or tool sends one wish by several ways: to the process and to its group.
constexpr Duration one_wish = 1s;
/// More than the supervisor allows itself for an orderly end.
constexpr Duration supervisor_grace = 15s;

[[nodiscard]] sigset_t handled_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&set, number);
  return set;
}

/// The next signal within the time; 0 when none came.
[[nodiscard]] int next_signal(const sigset_t& set, Duration limit) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(limit);
  const timespec span{whole.count(), (limit - whole).count()};
  const int number = ::sigtimedwait(&set, nullptr, &span);
  return number > 0 ? number : 0;
}

void end_devices(std::vector<Process>& devices, const sigset_t& set, const Clock& clock) {
  for (Process& device : devices) static_cast<void>(device.send_signal(SIGTERM));
  const TimePoint limit = clock.now() + device_grace;
  for (Process& device : devices) {
    for (;;) {
      const auto end = device.poll();
      if (!end || *end) break;
      if (clock.now() > limit) {
        static_cast<void>(device.send_signal(SIGKILL));
        break;
      }
      static_cast<void>(next_signal(set, 10ms));
    }
  }
}

}  // namespace

int keep(KeeperPlan plan) {
  const SystemClock clock;
  const sigset_t set = handled_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return exit_environment;
  const FileDescriptor watched{ends[0]};
  const FileDescriptor held{ends[1]};

  std::vector<Process> devices;
  devices.reserve(plan.devices.size());
  for (ProcessStart& start : plan.devices) {
    // Its end tells a device that the keeper is gone, however that came about: nobody else would end it.
    start.inherited.push_back({watched.get(), STDIN_FILENO});
    auto device = Process::spawn(start);
    if (!device) {
      std::fprintf(stderr, "hirosco: cannot start %s: %s\n", start.executable.c_str(), device.error().text);
      end_devices(devices, set, clock);
      return exit_environment;
    }
    devices.push_back(std::move(*device));
  }
  plan.supervisor.inherited.push_back({watched.get(), keeper_descriptor});
  auto supervisor = Process::spawn(plan.supervisor);
  if (!supervisor) {
    std::fprintf(stderr, "hirosco: cannot start %s: %s\n", plan.supervisor.executable.c_str(), supervisor.error().text);
    end_devices(devices, set, clock);
    return exit_environment;
  }

  const TimePoint started = clock.now();
  bool asked = false;
  TimePoint asked_at{};
  for (;;) {
    const auto end = supervisor->poll();
    if (end && *end) {
      end_devices(devices, set, clock);
      return (*end)->kind == ExitStatus::Kind::Exited ? (*end)->value : exit_internal;
    }
    const int number = next_signal(set, 100ms);
    const bool interrupted = number == SIGINT || number == SIGTERM || number == SIGHUP;
    const bool over = plan.run_for && !asked && clock.now() - started >= *plan.run_for;
    const bool overdue = asked && clock.now() - asked_at > supervisor_grace;
    const bool same_wish = asked && interrupted && clock.now() - asked_at < one_wish;
    if (same_wish || (!interrupted && !over && !overdue)) continue;
    // The first wish is for an orderly end, the second for an end; so is one that is not fulfilled in time.
    static_cast<void>(supervisor->send_signal(asked ? SIGKILL : SIGTERM));
    if (!asked) asked_at = clock.now();
    asked = true;
  }
}

}  // namespace hirosco::supervisor
