// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace hirosco::tools::doctor {
namespace {

using std::chrono::duration_cast;
using std::chrono::microseconds;

[[nodiscard]] Finding ok(std::string found) { return {Verdict::Ok, std::move(found), {}}; }
[[nodiscard]] Finding worth_knowing(std::string found, std::string mends = {}) {
  return {Verdict::WorthKnowing, std::move(found), std::move(mends)};
}
[[nodiscard]] Finding missing(std::string found, std::string mends = {}) {
  return {Verdict::Missing, std::move(found), std::move(mends)};
}

[[nodiscard]] std::string why(const Error& error) {
  return error.code == ErrorCode::SystemFailure ? std::strerror(static_cast<int>(error.value)) : error.text;
}
[[nodiscard]] double in_us(Duration span) { return std::chrono::duration<double, std::micro>(span).count(); }

/// Of pam_limits: read at the next login.
[[nodiscard]] std::string limits_line(const System& system, const char* what) {
  return fmt::format("echo '{} - {}' | sudo tee -a /etc/security/limits.d/90-hirosco.conf  # and log in again",
                     system.user, what);
}

Finding priority(const System& system) {
  if (!system.no_priority) return ok(fmt::format("SCHED_FIFO up to {} is granted", system.highest_priority));
  const std::string refused = fmt::format("SCHED_FIFO {} is refused to {}: {}; the reduced limits of time hold",
                                          system.highest_priority, system.user, why(*system.no_priority));
  // Who has the limit and is refused is in a control group that has no such time.
  if (system.priority_limit >= static_cast<std::uint64_t>(system.highest_priority) || system.user == "root")
    return missing(refused + " (its control group has no time for it)",
                   "echo 950000 | sudo tee /sys/fs/cgroup/cpu/$(sed -n 's/.*cpu[^:]*:.//p' "
                   "/proc/self/cgroup)/cpu.rt_runtime_us  # in a container: --cap-add SYS_NICE");
  return missing(refused, limits_line(system, "rtprio 95"));
}

Finding locked_memory(const System& system) {
  const std::string limit =
      system.memory_limit == unlimited ? "no limit" : fmt::format("limit {} KiB", system.memory_limit / 1024);
  if (!system.no_locked_memory) return ok(fmt::format("granted, {}", limit));
  return missing(fmt::format("refused, {}: {}", limit, why(*system.no_locked_memory)),
                 limits_line(system, "memlock unlimited"));
}

Finding isolation(const System& system) {
  if (system.open.empty()) return ok("files, signals, system calls");
  const std::string open = fmt::format("{}", fmt::join(system.open, "; "));
  const std::string mends = open.find("HIROSCO_SANDBOX") != std::string::npos ? "unset HIROSCO_SANDBOX"
                            : open.find("before version") != std::string::npos
                                ? "sudo apt install -t bookworm-backports linux-image-amd64  # Linux 6.7 or later"
                            : open.find("Landlock") != std::string::npos
                                ? "sudo sed -i 's/^GRUB_CMDLINE_LINUX=\"/&lsm=landlock,lockdown,yama,apparmor /' "
                                  "/etc/default/grub && sudo update-grub  # and restart"
                            : open.find("users of their own") != std::string::npos
                                ? "sudo systemctl edit hirosco@NAME  # rights of a unit: docs/guide/installing.md"
                                : "";
  return system.isolation_required ? missing(open + "; the mission requires all", mends) : worth_knowing(open, mends);
}

Finding processors(const System& system) {
  if (system.processors > 1)
    return ok(fmt::format("{}, cycles on number {}", system.processors, system.cycle_processor));
  return worth_knowing("one for cycles and everything else", "nproc --all  # taskset or cpuset allows one of these");
}

Finding quota(const System& system) {
  if (system.quota == 0) return ok("no bound");
  return missing(
      fmt::format("{:.2f} processors: whoever has used them up stands still until the next period", system.quota),
      fmt::format("echo max | sudo tee {}", system.group));
}

Finding throttling(const System& system) {
  const double share = static_cast<double>(system.realtime_us) / static_cast<double>(system.realtime_of_us);
  if (system.realtime_us < 0) return ok("none");
  if (share >= 0.95) return ok(fmt::format("{:.0f} % of each period are theirs", 100 * share));
  return missing(fmt::format("{:.0f} % of each period are theirs", 100 * share),
                 "sudo sysctl kernel.sched_rt_runtime_us=950000");
}

Finding kernel(const System& system) {
  if (system.realtime_kernel) return ok(fmt::format("{}, PREEMPT_RT", system.kernel));
  return worth_knowing(fmt::format("{}, {}: no PREEMPT_RT, so the longest wait has no bound", system.kernel,
                                   system.preemption.empty() ? "no preemption" : system.preemption),
                       "sudo apt install linux-image-rt-amd64  # and restart");
}

Finding governor(const System& system) {
  if (system.governor.empty()) return ok("none: the frequency is not this system's to choose");
  if (system.governor == "performance") return ok("performance");
  return worth_knowing(fmt::format("{}: cycles take longer while it is slow", system.governor),
                       "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor");
}

Finding clock(const System& system) {
  const std::string is =
      fmt::format("{}, in steps of {} ns", system.clock_source.empty() ? "a clock without a name" : system.clock_source,
                  system.resolution.count());
  if (system.resolution > 1us)
    return missing(is + ": too coarse for cycles",
                   "sudo sed -i 's/highres=off//' /etc/default/grub && sudo "
                   "update-grub  # and restart");
  const bool slow = system.clock_source == "hpet" || system.clock_source == "acpi_pm";
  return slow ? worth_knowing(is + ": each look at it takes a microsecond",
                              "echo tsc | sudo tee /sys/devices/system/clocksource/clocksource0/current_clocksource")
              : ok(is);
}

Finding calendar(const System& system) {
  return system.synchronised ? ok("kept by a time service")
                             : worth_knowing("not kept by any time service: on-board time is as wrong as it is",
                                             "sudo apt install systemd-timesyncd && sudo timedatectl set-ntp true");
}

Finding slack(const System& system) {
  const std::string is = fmt::format("{:.0f} us", in_us(system.timer_slack));
  if (!system.no_priority) return ok(is + ", which SCHED_FIFO does not have");
  return worth_knowing(is + ", by which every ordinary cycle may be late", limits_line(system, "rtprio 95"));
}

Finding wake_up(const System& system) {
  if (system.late.empty()) return worth_knowing("not measured");
  const Duration worst = system.late.back(), usual = system.late[system.late.size() / 2];
  const std::string is = fmt::format("{} sleeps of 500 us: {:.0f} us late as a rule, {:.0f} us at most",
                                     system.late.size(), in_us(usual), in_us(worst));
  if (worst < 500us) return ok(is);
  return worth_knowing(is + ", more than a cycle at 2 kHz", "bench/run  # says more of it; end other work meanwhile");
}

Finding ground_link(const System& system) {
  std::string free;
  for (const Port& port : system.ground_link) {
    if (port.why_not && !port.flight.empty())
      return worth_knowing(fmt::format("{} is that of the flight {}", port.address, port.flight),
                           fmt::format("hirosco run {} --instance NAME", system.mission));
    if (port.why_not)
      return missing(
          fmt::format("{}: {}", port.address, *port.why_not),
          fmt::format("hirosco run {} --instance NAME  # takes free ones; who has it: ss -ltnp", system.mission));
    free += (free.empty() ? "" : ", ") + port.address;
  }
  return ok(free.empty() ? "the mission has none" : free + " are free");
}

Finding page(const System& system) {
  if (!system.station)
    return worth_knowing("no program hirosco-ground",
                         "sudo apt install hirosco-ground  # in sources: npm, libboost-dev");
  if (!system.page_built) return worth_knowing("no page was built", "sudo apt install npm  # and build again");
  if (system.page.why_not) return ok(fmt::format("{} is taken: the next free port", system.page.address));
  return ok(fmt::format("{} is free", system.page.address));
}

Finding places(const System& system) {
  constexpr std::uint64_t mebi = 1024 * 1024, least = 64 * mebi;
  std::string are;
  for (const Place& place : system.places) {
    if (place.why_not)
      return missing(fmt::format("{}: {}", place.path.string(), *place.why_not),
                     fmt::format("sudo install -d -o {} {}", system.user, place.path.string()));
    if (place.free_octets < least)
      return missing(
          fmt::format("{}: {} MiB free, {} wanted", place.path.string(), place.free_octets / mebi, least / mebi),
          fmt::format("du -xh --max-depth 1 {} | sort -h", place.path.string()));
    are += fmt::format("{}{} ({} MiB free)", are.empty() ? "" : ", ", place.path.string(), place.free_octets / mebi);
  }
  return ok(are);
}

Finding programs(const System& system) {
  if (system.not_ready.empty()) return ok(fmt::format("all that {} names", system.mission));
  return missing(
      fmt::format("{}{}", system.not_ready.front(),
                  system.not_ready.size() > 1 ? fmt::format(" and {} more", system.not_ready.size() - 1) : ""),
      fmt::format("hirosco check --fly {}  # tells all, with places", system.mission));
}

Finding build_tools(const System& system) {
  if (!system.no_tools.empty())
    return worth_knowing(fmt::format("no {}", fmt::join(system.no_tools, ", no ")),
                         "sudo apt install g++ cmake make libgtest-dev libgmock-dev");
  // cmake does not take it by itself.
  const bool to_be_named = system.builder == "ninja";
  return ok(fmt::format("compiler, cmake, {}, gtest", to_be_named ? "ninja (cmake -G Ninja)" : system.builder));
}

/// A program without its module flies; one with an old module is told before somebody simulates or flies what he did not build.
Finding versions(const System& system) {
  if (!system.development_version.empty() && system.development_version != system.version) {
    const std::string other =
        fmt::format("hirosco {}, and {} is of another build, {}: what is built with it is refused", system.version,
                    system.development.string(), system.development_version);
    const char* const mends =
        "sudo apt install ./*hirosco*.deb  # where all packages of one build lie; from sources: build all, install "
        "again";
    return system.other_versions.empty() ? worth_knowing(other, mends) : missing(other, mends);
  }
  if (system.other_versions.empty())
    return ok(fmt::format("hirosco {}, and all that {} loads", system.version, system.mission));
  return missing(
      system.other_versions.front() +
          (system.other_versions.size() > 1 ? fmt::format(" and {} more", system.other_versions.size() - 1) : ""),
      "rm -r build && cmake -B build && cmake --build build  # in its folder");
}

Finding libraries(const System& system) {
  if (system.no_libraries.empty()) return ok(fmt::format("{}", fmt::join(system.libraries, ", ")));
  return missing(fmt::format("{}", fmt::join(system.no_libraries, "; ")), "sudo apt install --fix-broken");
}

Finding python(const System& system) {
  if (!system.python.empty()) return ok(system.python + ": no package besides its own library is wanted");
  return worth_knowing("no program python3", "sudo apt install python3");
}

Finding world(const System& system) {
  const World& world = system.world;
  const auto lacks = [&](std::string_view found, const std::string& mends) {
    return world.wanted ? missing(std::string{found}, mends)
                        : ok(fmt::format("{}; the mission has nobody in it", found));
  };
  if (world.package.empty()) return lacks("no template says which it is", "sudo apt install --reinstall hirosco");
  if (!world.program)
    return lacks("no program of it",
                 fmt::format("sudo apt install {}  # in sources: {}", world.package, world.fetcher));
  if (world.library.empty()) return lacks("its physics is not here: it is fetched, not packaged", world.fetcher);
  const std::string file = world.library.filename().string();
  if (world.fetched.empty()) return worth_knowing(file + ": nobody has written down its hash", world.fetcher);
  if (world.digest != world.fetched)
    return missing(file + " is not what was fetched: its SHA-256 is another one",
                   fmt::format("sudo rm {}; {}", world.library.string(), world.fetcher));
  return ok(file + ", as it was fetched");
}

constexpr std::array table{
    Row{"real-time rights", "cycles come before everything else", priority},
    Row{"locked memory", "no cycle waits for a page", locked_memory},
    Row{"isolation", "a subsystem reaches nothing but its own", isolation},
    Row{"processors", "cycles have one, all else the others", processors},
    Row{"processor quota", "nobody is stopped in the middle of a cycle", quota},
    Row{"throttling", "cycles get what they declare", throttling},
    Row{"kernel", "how long it keeps a cycle waiting", kernel},
    Row{"governor", "a cycle takes the same time each time", governor},
    Row{"clock", "when a cycle is due, and the age of what it reads", clock},
    Row{"calendar", "on-board time is TAI", calendar},
    Row{"timer slack", "how late an ordinary thread wakes", slack},
    Row{"wake-up", "how late a cycle begins", wake_up},
    Row{"ground link", "telemetry and telecommands", ground_link},
    Row{"page", "the ground station in a browser", page},
    Row{"folders", "locks and sockets, devices, log", places},
    Row{"programs", "subsystems, devices and modules of the mission", programs},
    Row{"versions", "what is loaded and what loads it are of one build", versions},
    Row{"libraries", "what others have written and all of it runs with", libraries},
    Row{"world", "robots that have a URDF file", world},
    Row{"python", "exported clients, campaigns and devices in Python", python},
    Row{"build tools", "subsystems and devices of your own", build_tools},
};

}  // namespace

std::span<const Row> rows() { return table; }

bool of_time(const Row& row) { return row.judge == priority || row.judge == locked_memory; }

}  // namespace hirosco::tools::doctor
