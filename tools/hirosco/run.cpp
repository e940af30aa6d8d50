// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/descriptor/model/member_reach.hpp"
#include "hirosco/subsystem/author/ground_transport.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "hirosco/utilities/os/own_user.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "simulation/devices/device_arguments.hpp"
#include "supervisor/keeper/keeper.hpp"
#include "supervisor/keeper/kept_endnodes.hpp"
#include "supervisor/platform/launch/own_users.hpp"
#include "supervisor/platform/launch/spare_folders.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/flight_lock.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/readiness.hpp"
#include "tools/terminal/flight_screen.hpp"

namespace hirosco::tools {
namespace {

/// Who asks for an end in the first moments gets an orderly one, and who asks for a stop ends nothing by it.
void hold_back_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) sigaddset(&set, number);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

/// Every process of the flight, those started again later, too, counts from the same epoch (adr 0038).
void fix_epoch() {
  const Duration epoch = SystemClock::calendar_epoch(SystemClock::default_tai_minus_utc);
  ::setenv(flight_epoch_variable, std::to_string(epoch.count()).c_str(), 1);
}

/// Every process of the flight knows where it belongs, those started again later, too: by environment.
void tell_children(const FlightEntry& flight, const descriptor::Mission& mission) {
  const auto tell = [](const char* variable, const std::string& value) {
    if (value.empty()) ::unsetenv(variable);
    else ::setenv(variable, value.c_str(), 1);
  };
  tell(telemetry_address_variable, flight.telemetry);
  tell(telecommand_address_variable, flight.telecommand);
  tell(flight_instance_variable, flight.named() ? flight.instance : std::string{});
  tell(device_networks_variable, words_of(mission.device_networks));
}

/// Whoever names a flight has to know where to find what is its own.
void introduce(const FlightEntry& flight, const RunOptions& options) {
  if (!flight.named() || options.quiet) return;
  if (options.json)
    fmt::print("{}\n", json_line({{"instance", flight.instance},
                                  {"telemetry", flight.telemetry},
                                  {"telecommand", flight.telecommand},
                                  {"log", flight.log.string()},
                                  {"folder", flight.folder.string()}}));
  else
    fmt::print("instance {}: telemetry {}, telecommands {}, log {}\n", flight.instance, flight.telemetry,
               flight.telecommand, flight.log.string());
  std::fflush(stdout);
}

/// What was injected in the flight before this one.
void clear_injections(const descriptor::Mission& mission, const std::filesystem::path& folder) {
  std::error_code failed;
  for (const auto& device : mission.devices)
    std::filesystem::remove((folder / device.name).string() + ".injected", failed);
}

/// Who was killed leaves its socket behind. Nobody of this flight lives any more, and its folder is still locked.
void clear_sockets(const descriptor::Mission& mission, const std::filesystem::path& folder) {
  std::error_code failed;
  for (const auto& device : mission.devices)
    if (std::filesystem::is_socket(folder / device.name, failed)) std::filesystem::remove(folder / device.name, failed);
}

/// Nobody of this flight lives any more, and no other has its name. Where it is its mission's name they stay, as many as descriptors name:
/// those of another mission that has the same devices may be the same, and somebody be let in there by now (docs/adr/0169). Into those of
/// users of their own nobody else is let, so they go.
void clear_places(const descriptor::Mission& mission, const FlightEntry& flight, ProcessUser user) {
  supervisor::SpareFolders::sweep();
  if (!flight.named() && user == ProcessUser::WhoeverFlies) return;
  for (const auto& member : mission.subsystems)
    for (const FlowAddress& flow : descriptor::flows_of(member.subsystem)) remove_place(flow, flight_instance(), user);
}

/// Before the first device makes anything: the folders of all that are users of their own. False: one cannot be, which was printed.
[[nodiscard]] bool take_users(const descriptor::Mission& mission) {
  const auto& users = *mission.users;
  if (const std::string other = process_of_users(users.first, users.last); !other.empty()) {
    fmt::print(
        stderr,
        "hirosco run: users {} to {} are to be this flight's alone, and {} is one of them: end it, or name others "
        "in <Isolation>\n",
        users.first, users.last, other);
    return false;
  }
  for (const auto& member : mission.subsystems)
    if (const auto made =
            supervisor::make_own_places(member, {member.user.value_or(users.first), {users.first, users.last}},
                                        flight_instance(), PlaceTime::BeforeFlight);
        !made) {
      fmt::print(stderr, "hirosco run: {}\n", made.error());
      return false;
    }
  return true;
}

/// One flight of an instance at a time: the lock lives as long as the process. It tells `hirosco safe` whom to signal.
[[nodiscard]] FileDescriptor take_folder(const std::filesystem::path& folder, const descriptor::Mission& mission) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all, failed);
  auto lock = take_lock(folder / "lock");
  if (!lock) return {};
  Duration longest{};
  for (const auto& member : mission.subsystems)
    for (const auto& device : member.subsystem.devices) longest = std::max(longest, device.stop_within);
  // The guard waits for the device, then ends its subsystem and waits for that.
  const auto limit = std::chrono::duration_cast<std::chrono::milliseconds>(longest + std::chrono::seconds{1});
  const std::string text = lock_text({.keeper = ::getpid(), .limit = limit, .mission = mission.name});
  if (::ftruncate(lock->get(), 0) != 0 || ::write(lock->get(), text.data(), text.size()) < 0) return {};
  return std::move(*lock);
}

/// One log has one writer, whatever the runtime folder is: its lock stands beside it. Where none can be made the supervisor
/// tells why, as it cannot write the log either. False: another flight writes it.
[[nodiscard]] bool take_log_lock(const std::filesystem::path& log, FileDescriptor& lock) {
  std::error_code failed;
  std::filesystem::create_directories(log.parent_path(), failed);
  auto taken = take_lock(log.string() + ".lock");
  if (taken) lock = std::move(*taken);
  return taken || taken.error().code != ErrorCode::Unavailable;
}

/// The locks of one flight. The supervisor inherits them: where the keeper was killed, nobody else flies with this name,
/// this log or these ports before its supervisor has ended, too.
struct Locks {
  FileDescriptor folder;
  FileDescriptor log;
  FileDescriptor registry;
};

/// Fills in the ports of the flight; empty, and the reason was printed, when it cannot be.
[[nodiscard]] std::optional<Locks> take_locks(const descriptor::Mission& mission, FlightEntry& flight) {
  Locks locks;
  locks.folder = take_folder(flight.folder, mission);
  if (!locks.folder) {
    fmt::print(stderr, "hirosco run: {} flies already, or {} cannot be written\n", flight.instance,
               flight.folder.string());
    return std::nullopt;
  }
  const std::filesystem::path log = instance_log(mission, flight.instance);
  if (!take_log_lock(log, locks.log)) {
    fmt::print(stderr, "hirosco run: another flight writes {} already\n", log.string());
    return std::nullopt;
  }
  auto entered = FlightRegistry{}.enter(flight);
  if (!entered) {
    fmt::print(stderr, "hirosco run: {}\n", entered.error());
    return std::nullopt;
  }
  flight = std::move(entered->flight);
  locks.registry = std::move(entered->lock);
  return locks;
}

[[nodiscard]] std::optional<ProcessStart> device_start(const descriptor::Mission& mission,
                                                       const descriptor::SimulatedDevice& device,
                                                       const std::filesystem::path& folder) {
  const auto program = find_program(device.executable);
  const auto made = simulation::device_arguments(mission, device);
  if (!made) {
    fmt::print(stderr, "hirosco run: no simulated device {}: {}\n", device.name, made.error());
    return std::nullopt;
  }
  if (program.empty()) {
    fmt::print(stderr, "hirosco run: no program {} for the simulated device {}\n", device.executable, device.name);
    return std::nullopt;
  }
  ProcessStart start;
  start.executable = program.string();
  start.arguments = made->arguments();
  start.arguments.insert(start.arguments.end(),
                         {"--seed", std::to_string(device.seed), "--control", (folder / device.name).string()});
  if (device.core) start.arguments.insert(start.arguments.end(), {"--core", std::to_string(*device.core)});
  for (const auto& [name, value, at] : device.settings)
    if (name != simulation::world_setting) start.arguments.insert(start.arguments.end(), {"--set", name + "=" + value});
  return start;
}

/// One process for each world, with all that are in it. False: one cannot be, which was printed.
[[nodiscard]] bool start_devices(const descriptor::Mission& mission, const std::filesystem::path& folder,
                                 std::vector<ProcessStart>& starts) {
  std::map<std::string_view, std::size_t> worlds;
  for (const auto& device : mission.devices) {
    auto start = device_start(mission, device, folder);
    if (!start) return false;
    const auto world = simulation::whose_world(mission, device);
    if (!world) {
      fmt::print(stderr, "hirosco run: no simulated device {}: {}\n", device.name, world.error());
      return false;
    }
    if (*world != nullptr) {
      auto& together = starts[worlds.at((*world)->name)].arguments;
      together.emplace_back(simulation::beside_word);
      together.insert(together.end(), start->arguments.begin(), start->arguments.end());
      continue;
    }
    worlds[device.name] = starts.size();
    starts.push_back(std::move(*start));
  }
  return true;
}

}  // namespace

int run(const RunOptions& options) {
  hold_back_signals();
  if (options.mission.empty()) {
    fmt::print(stderr, "hirosco run: which mission? there are: {}\n", fmt::join(known_missions(), ", "));
    return exit_usage;
  }
  auto mission = load_mission(options.mission);
  if (!mission) return exit_finding;
  if (!options.mode.empty())
    if (const auto why_not = descriptor::start_in(*mission, options.mode)) {
      fmt::print(stderr, "hirosco run: {}\n", *why_not);
      return exit_usage;
    }
  if (!ready(*mission, options.threads ? FlownAs::Threads : FlownAs::Processes)) return exit_environment;
  FlightEntry flight = plan_flight(*mission, options.instance.empty() ? mission->name : options.instance);
  if (!good_instance(flight.instance)) {
    fmt::print(stderr, "hirosco run: '{}' is no name of a flight: letters, digits, '-' and '_', at most 64\n",
               flight.instance);
    return exit_usage;
  }
  const auto locks = take_locks(*mission, flight);
  if (!locks) return exit_environment;
  const auto& folder = flight.folder;
  // Behind what is another flight's alone, and before whoever inherits it; a cycle, device or service loop goes from here to its own core.
  if (ProcessorSet::of_this_thread().beyond(flight.cores.processors))
    if (const auto taken = flight.cores.processors.take(); !taken) {
      fmt::print(stderr, "hirosco run: the cores that are left to the flight ({}) cannot be taken: {}\n",
                 to_string(flight.cores.processors), taken.error().text);
      return exit_environment;
    }
  introduce(flight, options);
  tell_children(flight, *mission);
  clear_injections(*mission, folder);
  fix_epoch();
  // As its supervisor, too, has to find: else all are of this user, which that tells (docs/adr/0177).
  const bool own_users = mission->users && !options.threads && supervisor::why_one_user(*mission, true).empty();
  if (own_users && !take_users(*mission)) return exit_environment;
  supervisor::KeeperPlan plan;
  plan.run_for = options.run_for;
  if (!start_devices(*mission, folder, plan.devices)) return exit_environment;
  const bool wants_screen = !options.plain && !options.json && !options.quiet &&
                            !find_program("hirosco-screen").empty() && terminal::FlightScreen::possible();
  // Not everybody builds it, and no flight needs it but the tour.
  const auto station = find_program("hirosco-ground");
  if (options.tour && station.empty()) {
    fmt::print(stderr, "hirosco tour: no program hirosco-ground beside this one or in PATH: {}\n", station_needs);
    return exit_environment;
  }
  if (options.ground && !station.empty()) {
    ProcessStart start;
    start.executable = station.string();
    start.arguments = {"--child", "--mission", mission->file.string(), "--devices", folder.string()};
    if (!flight.telemetry.empty()) start.arguments.insert(start.arguments.end(), {"--telemetry", flight.telemetry});
    if (flight.named())
      start.arguments.insert(start.arguments.end(), {"--archive", archive_beside(flight.log).string()});
    if (options.json || wants_screen) start.arguments.emplace_back("--json");
    if (options.quiet) start.arguments.emplace_back("--quiet");
    if (options.tour) start.arguments.emplace_back("--tour");
    plan.devices.push_back(std::move(start));
  }
  const std::string_view name = options.threads ? "hirosco-threads" : "hirosco-supervisor";
  const auto program = find_program(name);
  if (program.empty()) {
    fmt::print(stderr, "hirosco run: no program {} beside this one or in PATH\n", name);
    return exit_environment;
  }
  plan.supervisor.executable = program.string();
  // The next supervisor of this flight is the same program, whatever an upgrade has put in its place by then.
  const FileDescriptor image{::open(program.c_str(), O_PATH | O_CLOEXEC)};
  if (image) plan.supervisor.image = image.get();
  plan.supervisor.arguments = {"--mission", mission->file.string(), "--runtime", folder.string()};
  if (!options.mode.empty())
    plan.supervisor.arguments.insert(plan.supervisor.arguments.end(), {"--mode", options.mode});
  if (flight.named()) plan.supervisor.arguments.insert(plan.supervisor.arguments.end(), {"--log", flight.log.string()});
  for (auto& endnode : supervisor::kept_endnodes(*mission)) plan.inhibits.push_back(std::move(endnode.address));
  constexpr int first_lock = supervisor::keeper_texts_descriptor + 1;
  static_assert(first_lock + 3 < supervisor::flight_held_descriptor, "the keeper hands over what comes behind");
  plan.supervisor.inherited = {{locks->folder.get(), first_lock}, {locks->registry.get(), first_lock + 1}};
  if (locks->log) plan.supervisor.inherited.push_back({locks->log.get(), first_lock + 2});
  plan.supervisor.over_users = own_users;
  if (own_users) plan.supervisor.arguments.emplace_back("--own-users");
  if (options.json) plan.supervisor.arguments.emplace_back("--json");
  if (options.quiet) plan.supervisor.arguments.emplace_back("--quiet");
  auto screen = wants_screen ? terminal::FlightScreen::start(flight.log) : std::nullopt;
  if (screen) {
    plan.beside = screen->process();
    plan.supervisor.inherited.push_back({screen->told(), first_lock + 3});
    plan.supervisor.arguments.insert(plan.supervisor.arguments.end(), {"--screen", std::to_string(first_lock + 3)});
  }
  // It has read the whole mission, and is a small process from here on.
  give_back_what_is_free();
  const int code = supervisor::keep(std::move(plan));
  screen.reset();
  clear_sockets(*mission, folder);
  clear_places(*mission, flight, own_users ? ProcessUser::ItsOwn : ProcessUser::WhoeverFlies);
  return code;
}

}  // namespace hirosco::tools
