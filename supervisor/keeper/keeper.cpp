// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/keeper.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <new>
#include <string_view>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/linux/memfd.hpp"
#include "hirosco/utilities/os/shared_memory.hpp"

namespace hirosco::supervisor {
namespace {

constexpr int exit_environment = 3;
constexpr int exit_internal = 4;
constexpr Duration device_grace = 1s;
/// A terminal or tool sends one wish by several ways: to the process and to its group.
constexpr Duration one_wish = 1s;
/// What a subsystem may take to make itself safe and end once the supervisor is gone.
constexpr Duration orphan_grace = 5s;
/// More than the supervisor allows itself for an orderly end.
constexpr Duration supervisor_grace = 15s;

[[nodiscard]] sigset_t handled_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD, SIGUSR1}) sigaddset(&set, number);
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

/// Calls `with` for each child of this process. Where the system does not tell them there are none.
template <class With>
void each_child(With&& with) {
  std::array<char, 4096> text;
  std::array<char, 64> path;
  std::snprintf(path.data(), path.size(), "/proc/self/task/%d/children", static_cast<int>(::getpid()));
  const FileDescriptor file{::open(path.data(), O_RDONLY | O_CLOEXEC)};
  const auto octets = file ? ::read(file.get(), text.data(), text.size()) : 0;
  std::string_view rest{text.data(), static_cast<std::size_t>(std::max<ssize_t>(octets, 0))};
  while (!rest.empty()) {
    int pid = 0;
    const auto [end, problem] = std::from_chars(rest.data(), rest.data() + rest.size(), pid);
    if (problem != std::errc{}) return;
    with(pid);
    rest.remove_prefix(std::min<std::size_t>(static_cast<std::size_t>(end - rest.data()) + 1, rest.size()));
  }
}

/// Subsystems whose supervisor died come to us: they make themselves safe and end, and who spins instead is ended.
void end_orphans(const std::vector<Process>& devices, const sigset_t& set, const Clock& clock) {
  const TimePoint limit = clock.now() + orphan_grace;
  for (bool left = true; left;) {
    left = false;
    each_child([&](int pid) {
      if (std::ranges::find(devices, pid, &Process::pid) != devices.end()) return;
      if (::waitpid(pid, nullptr, WNOHANG) != 0) return;  // it has ended and is reaped
      left = true;
      if (clock.now() > limit) ::kill(pid, SIGKILL);      // ours until it is reaped: nobody else has its number
    });
    if (left) static_cast<void>(next_signal(set, 20ms));
  }
}

/// Nothing ends here without a word of what the system refused.
int refused(const char* what, std::int64_t number) {
  std::fprintf(stderr, "hirosco: %s: %s\n", what, std::strerror(static_cast<int>(number)));
  return exit_environment;
}

}  // namespace

int keep(KeeperPlan plan) {
  const SystemClock clock;
  const sigset_t set = handled_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return refused("no pipe to watch over the flight", errno);
  const FileDescriptor watched{ends[0]};
  const FileDescriptor held{ends[1]};

  ::prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0);
  const auto page_memory = memfd::create("hirosco-keeper", sizeof(KeeperPage));
  auto mapped = page_memory ? MappedMemory::map(page_memory->get(), sizeof(KeeperPage), MapMode::ReadWrite)
                            : Result<MappedMemory>{fail(ErrorCode::SystemFailure, "memory of the keeper")};
  if (!mapped) {
    const Error& why = page_memory ? mapped.error() : page_memory.error();
    return refused("no memory to watch over the flight", why.value);
  }
  auto& page = *::new (mapped->octets().data()) KeeperPage;

  std::vector<Process> devices;
  devices.reserve(plan.devices.size());
  for (ProcessStart& start : plan.devices) {
    // Its end tells a device that the keeper is gone, however that came about: nobody else would end it.
    start.inherited.push_back({watched.get(), STDIN_FILENO});
    auto device = Process::spawn(start);
    if (!device) {
      end_devices(devices, set, clock);
      return refused(("cannot start " + start.executable).c_str(), device.error().value);
    }
    devices.push_back(std::move(*device));
  }
  plan.supervisor.inherited.push_back({watched.get(), keeper_descriptor});
  plan.supervisor.inherited.push_back({page_memory->get(), keeper_page_descriptor});
  // It is asked for its end before it can listen, too.
  plan.supervisor.blocked = {SIGTERM, SIGINT, SIGUSR1};
  auto supervisor = Process::spawn(plan.supervisor);
  if (!supervisor) {
    end_devices(devices, set, clock);
    return refused(("cannot start " + plan.supervisor.executable).c_str(), supervisor.error().value);
  }

  const TimePoint started = clock.now();
  bool asked = false;
  TimePoint asked_at{};
  Progress progress;
  bool stood_still = false;
  for (;;) {
    page.keeper.fetch_add(1, std::memory_order_relaxed);
    const auto end = supervisor->poll();
    if (end && *end) {
      end_orphans(devices, set, clock);
      end_devices(devices, set, clock);
      return (*end)->kind == ExitStatus::Kind::Exited ? (*end)->value : exit_internal;
    }
    if (!stood_still && progress.stands_still(page.supervisor.load(std::memory_order_relaxed), clock.now())) {
      stood_still = true;
      std::fputs("hirosco: the supervisor stands still and is ended; the subsystems make themselves safe\n", stderr);
      static_cast<void>(supervisor->send_signal(SIGKILL));
    }
    const int number = next_signal(set, 100ms);
    if (number == SIGUSR1) static_cast<void>(supervisor->send_signal(SIGUSR1));  // its guard stops everything
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
