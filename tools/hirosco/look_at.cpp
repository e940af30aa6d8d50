// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/look_at.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <sstream>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/version.hpp"
#include "supervisor/keeper/keeper.hpp"
#include "supervisor/platform/launch/own_users.hpp"
#include "supervisor/platform/launch/sha256.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/new_folder/robot_world.hpp"

namespace hirosco::tools::doctor {
namespace {

namespace fs = std::filesystem;

/// What a subsystem of the demonstrator keeps in memory, about.
constexpr std::size_t locked_octets = 32U * 1024 * 1024;
constexpr int sleeps = 200;
constexpr Duration cycle = 500us;
constexpr const char* page_address = "127.0.0.1:8080";

/// The first line; empty where there is none.
[[nodiscard]] std::string line_of(const fs::path& file) {
  std::ifstream text{file};
  std::string line;
  std::getline(text, line);
  return line;
}

[[nodiscard]] std::string octets_of(const fs::path& file) {
  std::ostringstream octets;
  octets << std::ifstream{file, std::ios::binary}.rdbuf();
  return std::move(octets).str();
}

[[nodiscard]] std::uint64_t limit_of(__rlimit_resource_t which) {
  rlimit limit{};
  return ::getrlimit(which, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ? unlimited : limit.rlim_cur;
}

/// In a process of its own, which ends: what is locked stays locked. By its exit code, the system's number of an error.
[[nodiscard]] std::optional<Error> try_locked_memory() {
  const pid_t child = ::fork();
  if (child < 0) return Error{ErrorCode::SystemFailure, "no process to try it in", errno};
  if (child == 0) {
    const auto locked = lock_memory();
    if (!locked) ::_exit(static_cast<int>(locked.error().value));
    void* const more = ::mmap(nullptr, locked_octets, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ::_exit(more == MAP_FAILED ? errno : 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::nullopt;
  return Error{ErrorCode::SystemFailure, "locked memory", WIFEXITED(status) ? WEXITSTATUS(status) : ENOMEM};
}

/// In a thread of its own, which ends.
void try_priority(System& system) {
  system.highest_priority = supervisor::keeper_priority;
  auto thread = Thread::start("doctor", [&] {
    if (const auto granted = set_fifo_priority(system.highest_priority); !granted) system.no_priority = granted.error();
    static_cast<void>(pin_to_cycle_cpu());
    static_cast<void>(system.no_priority ? ask_for_short_slices()
                                         : set_fifo_priority(descriptor::greatest_cycle_priority));
    system.cycle_processor = static_cast<unsigned>(std::max(::sched_getcpu(), 0));
    const SystemClock clock;
    TimePoint due = clock.now();
    for (int i = 0; i < sleeps; ++i) {
      due += cycle;
      sleep_until(due);
      const TimePoint now = clock.now();
      system.late.push_back(now - due);
      due = std::max(due, now - cycle);
    }
  });
  if (!thread) system.no_priority = thread.error();
  else thread->join();
  std::ranges::sort(system.late);
}

void look_at_rights(System& system, const descriptor::Mission& mission) {
  const passwd* const user = ::getpwuid(::getuid());
  system.user = user != nullptr ? user->pw_name : std::to_string(::getuid());
  system.no_locked_memory = try_locked_memory();  // before there is a second thread
  try_priority(system);
  system.priority_limit = limit_of(RLIMIT_RTPRIO);
  system.memory_limit = limit_of(RLIMIT_MEMLOCK);
  system.open = isolation_lacks();
  if (const std::string one_user = supervisor::why_one_user(mission, true); !one_user.empty())
    system.open.push_back(one_user);
  system.isolation_required = mission.isolation_required;
}

/// The narrowest quota of our control group and those above it, of the second version or the first.
void look_at_group(System& system) {
  std::ifstream groups{"/proc/self/cgroup"};
  for (std::string line; std::getline(groups, line);) {
    const auto last = line.rfind(':');
    const auto first = line.find(':');
    if (last == std::string::npos || first == last || line.size() < last + 2) continue;
    const std::string controllers = line.substr(first + 1, last - first - 1);
    const bool second = controllers.empty();
    if (!second && controllers.find("cpu") != 0) continue;
    const fs::path root = second ? "/sys/fs/cgroup" : fs::path{"/sys/fs/cgroup"} / controllers;
    for (fs::path group = root / line.substr(last + 2);; group = group.parent_path()) {
      double quota = 0, period = 0;
      const fs::path file = group / (second ? "cpu.max" : "cpu.cfs_quota_us");
      std::istringstream{line_of(file)} >> quota >> period;
      if (!second) std::istringstream{line_of(group / "cpu.cfs_period_us")} >> period;
      if (quota > 0 && period > 0 && (system.quota == 0 || quota / period < system.quota)) {
        system.quota = quota / period;
        system.group = file.string();
      }
      if (group == root || !group.has_relative_path()) break;
    }
  }
}

void look_at_processors(System& system) {
  system.processors = usable_processors();
  look_at_group(system);
  system.realtime_us = system.realtime_of_us = -1;
  std::istringstream{line_of("/proc/sys/kernel/sched_rt_runtime_us")} >> system.realtime_us;
  std::istringstream{line_of("/proc/sys/kernel/sched_rt_period_us")} >> system.realtime_of_us;
  system.governor =
      line_of(fmt::format("/sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", system.cycle_processor));
  utsname name{};
  ::uname(&name);
  system.kernel = name.release;
  std::istringstream words{name.version};
  for (std::string word; words >> word;)
    if (word.starts_with("PREEMPT")) system.preemption = word;
  system.realtime_kernel = line_of("/sys/kernel/realtime") == "1" || system.preemption == "PREEMPT_RT";
}

void look_at_clocks(System& system) {
  system.clock_source = line_of("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  timespec step{};
  ::clock_getres(CLOCK_MONOTONIC, &step);
  system.resolution = std::chrono::seconds{step.tv_sec} + Duration{step.tv_nsec};
  timex asked{};
  system.synchronised = ::adjtimex(&asked) != TIME_ERROR && (asked.status & STA_UNSYNC) == 0;
  system.timer_slack = Duration{std::max(::prctl(PR_GET_TIMERSLACK), 0)};
}

/// Where it is not there yet, that which it would be made in. A file is made and gone again.
[[nodiscard]] Place look_at_place(fs::path folder) {
  std::error_code failed;
  if (folder.empty()) folder = fs::current_path(failed);
  while (!fs::exists(folder, failed) && folder.has_relative_path())
    folder = folder.has_parent_path() ? folder.parent_path() : fs::current_path(failed);
  Place place{.path = folder, .why_not = {}};
  std::string pattern = (folder / ".hirosco-doctor-XXXXXX").string();
  if (const FileDescriptor made{::mkstemp(pattern.data())}; made) ::unlink(pattern.c_str());
  else place.why_not = std::strerror(errno);
  struct statvfs found{};
  if (::statvfs(folder.c_str(), &found) == 0) place.free_octets = std::uint64_t{found.f_bavail} * found.f_frsize;
  return place;
}

[[nodiscard]] Port look_at_port(const std::string& address, const std::vector<FlightEntry>& flights) {
  Port port{.address = address, .why_not = {}, .flight = {}};
  if (const auto free = can_listen(address); !free) port.why_not = free.error().text;
  for (const FlightEntry& flight : flights)
    if (flight.telemetry == address || flight.telecommand == address) port.flight = flight.instance;
  return port;
}

/// Files of others that this process has mapped, each once.
[[nodiscard]] std::vector<std::string> libraries_in_use() {
  std::vector<std::string> found;
  std::ifstream maps{"/proc/self/maps"};
  for (std::string line; std::getline(maps, line);) {
    const auto slash = line.rfind('/');
    if (slash == std::string::npos || line.find(".so") == std::string::npos) continue;
    std::string name = line.substr(slash + 1);
    if (name.starts_with("lib") && std::ranges::find(found, name) == found.end()) found.push_back(std::move(name));
  }
  std::ranges::sort(found);
  return found;
}

/// What has no module flies as a program all the same; whether that is here is said elsewhere.
void look_at_module(System& system, const std::string& program, ModuleKind kind) {
  if (find_module(program).empty()) return;
  const auto loaded = load_module_of(program, kind);
  if (loaded) return;
  const bool lacks_another = loaded.error().find("cannot open shared object") != std::string::npos;
  auto& where = lacks_another ? system.no_libraries : system.other_versions;
  if (std::ranges::find(where, loaded.error()) == where.end()) where.push_back(loaded.error());
}

/// The interface_version in the octets of a library, "0.1.0 interface 0123456789ab" (version.cmake); empty: there is none.
[[nodiscard]] std::string interface_in(const std::string& octets) {
  constexpr std::string_view word{" interface "};
  constexpr std::size_t digits = 12;
  for (auto at = octets.find(word); at != std::string::npos; at = octets.find(word, at + 1)) {
    std::size_t begin = at;
    while (begin > 0 && std::string_view{"0123456789."}.find(octets[begin - 1]) != std::string_view::npos) --begin;
    const std::string sum = octets.substr(at + word.size(), digits);
    if (begin < at && sum.size() == digits && sum.find_first_not_of("0123456789abcdef") == std::string::npos)
      return octets.substr(begin, at - begin).append(word).append(sum);
  }
  return {};
}

/// What modules are built with, where it is installed: beside this program, or in ../lib/hirosco.
void look_at_development(System& system) {
  const fs::path folder = this_program().parent_path();
  std::error_code failed;
  for (const fs::path& place : {folder, folder.parent_path() / "lib" / "hirosco"}) {
    const fs::path library = place / "libhirosco_utilities.a";
    if (!fs::is_regular_file(library, failed)) continue;
    system.development = library;
    system.development_version = interface_in(octets_of(library));
    return;
  }
}

void look_at_parts(System& system, const descriptor::Mission& mission, const RobotWorld& robots) {
  system.version = interface_version;
  look_at_development(system);
  system.libraries = libraries_in_use();  // before anything of the mission is loaded
  for (const auto& member : mission.subsystems) look_at_module(system, member.executable, ModuleKind::Subsystem);
  for (const auto& device : mission.devices)
    if (device.executable != robots.program) look_at_module(system, device.executable, ModuleKind::SimulatedDevice);
  std::error_code failed;
  if (const fs::path python = find_program("python3"); !python.empty())
    system.python = fs::canonical(python, failed).filename().string();
}

/// Beside the module, where a package has it fetched to, or where a build has it from.
[[nodiscard]] fs::path world_library(const fs::path& module, const RobotWorld& robots) {
  const fs::path folder = module.parent_path();
  std::error_code failed;
  for (const fs::path& place :
       {folder, folder / robots.word / "lib", folder.parent_path().parent_path() / robots.word / "lib"})
    for (const auto& file : fs::directory_iterator{place, failed})
      if (file.path().filename().string().starts_with(robots.library)) return file.path();
  return {};
}

/// That of robots, whose physics is fetched (docs/adr/0129).
void look_at_world(World& world, const descriptor::Mission& mission, const RobotWorld& robots) {
  world.package = robots.package;
  if (robots.program.empty()) return;
  world.wanted =
      std::ranges::any_of(mission.devices, [&](const auto& each) { return each.executable == robots.program; });
  world.program = !find_program(robots.program).empty();
  const fs::path module = find_module(robots.program);
  const fs::path fetcher = module.parent_path() / robots.fetcher;
  std::error_code failed;
  world.fetcher = fs::exists(fetcher, failed)
                      ? fmt::format("sudo {} {}", fetcher.string(), (module.parent_path() / robots.word).string())
                      : fmt::format("tools/{}  # and build again", robots.fetcher);
  if (module.empty()) return;
  world.library = world_library(module, robots);
  if (world.library.empty()) return;
  const std::string text = octets_of(world.library);
  world.digest = supervisor::sha256(std::as_bytes(std::span{text}));
  std::istringstream{line_of(world.library.parent_path().parent_path() / "SHA256")} >> world.fetched;
}

}  // namespace

System look_at(const descriptor::Mission& mission) {
  System system;
  look_at_rights(system, mission);
  look_at_processors(system);
  look_at_clocks(system);
  const FlightEntry flight = plan_flight(mission, mission.name);
  const auto flights = FlightRegistry{}.flights();
  system.mission = mission.file.string();
  const RobotWorld robots = robot_world(find_shipped("templates"));
  look_at_parts(system, mission, robots);
  look_at_world(system.world, mission, robots);
  for (const std::string& address : {flight.telemetry, flight.telecommand})
    if (!address.empty()) system.ground_link.push_back(look_at_port(address, flights));
  system.page = look_at_port(page_address, flights);
  for (const fs::path& folder : {runtime_root(), fs::path{"/dev/shm"}, flight.log.parent_path()})
    system.places.push_back(look_at_place(folder));
  system.station = !find_program("hirosco-ground").empty();
  system.page_built = !find_shipped("page").empty();
  for (const char* tool : {"c++", "cmake"})
    if (find_program(tool).empty()) system.no_tools.emplace_back(tool);
  system.builder = !find_program("make").empty() ? "make" : !find_program("ninja").empty() ? "ninja" : "";
  if (system.builder.empty()) system.no_tools.emplace_back("make");
  const auto has_header = [](const char* folder) { return fs::exists(fs::path{folder} / "gtest/gtest.h"); };
  if (!has_header("/usr/include") && !has_header("/usr/local/include")) system.no_tools.emplace_back("gtest");
  return system;
}

}  // namespace hirosco::tools::doctor
