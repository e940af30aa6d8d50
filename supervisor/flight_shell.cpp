// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/flight_shell.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <expected>
#include <filesystem>
#include <fstream>
#include <set>
#include <system_error>

#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/descriptor/model/cores.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/memory_reserve.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/last_words.hpp"
#include "hirosco/utilities/os/line_writer.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/wait_set.hpp"
#include "hirosco/utilities/program_options.hpp"
#include "supervisor/console.hpp"
#include "supervisor/guard/guard_shell.hpp"
#include "supervisor/guard/life_watch.hpp"
#include "supervisor/inheritance.hpp"
#include "supervisor/keeper/job_control.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/keeper_watch.hpp"
#include "supervisor/platform/storage/begin_log.hpp"
#include "supervisor/platform/storage/epoch_file.hpp"
#include "supervisor/platform/storage/log_store.hpp"
#include "supervisor/platform/storage/postgresql_database.hpp"
#include "supervisor/platform/storage/value_store.hpp"
#include "supervisor/supervisor.hpp"
#include "supervisor/unprovoked_reactions.hpp"

namespace hirosco::supervisor {
namespace {

constexpr int exit_finding = 1;
constexpr int exit_usage = 2;
constexpr int exit_environment = 3;
constexpr int exit_internal = 4;
constexpr int exit_unprovoked = 5;
/// Below the cycles of what moves, above ordinary work; the supervisor's descriptor says none (docs/adr/0203).
constexpr int supervisor_priority = 30;
constexpr Duration last_wait = 2s;
static_assert(ending_patience > 3 * last_wait, "the keeper ends nobody who waits for a disk at its end");
constexpr Duration log_start_limit = 3s;
/// More than one step takes: 256 messages of each member, each of 1 kB and copied for log and ground.
constexpr std::size_t memory_of_a_step = std::size_t{4} << 20;

struct Options {
  std::filesystem::path mission;
  std::filesystem::path log;         ///< empty = as the mission says
  std::filesystem::path runtime;     ///< folder of this flight: sockets, what was injected
  std::string mode;                  ///< to start in; empty = the mission's
  Console::Style style{Console::Style::Text};
  bool own_users{false};             ///< who started this has the right to end such
  int screen{-1};                    ///< descriptor that a screen reads from; -1: none
};

constexpr std::array known_options{ProgramOption{"--mission", "FILE"},
                                   ProgramOption{"--log", "FILE"},
                                   ProgramOption{"--runtime", "FOLDER"},
                                   ProgramOption{"--mode", "NAME"},
                                   ProgramOption{"--json"},
                                   ProgramOption{"--quiet"},
                                   ProgramOption{"--own-users"},
                                   ProgramOption{"--screen", "DESCRIPTOR"}};

[[nodiscard]] std::expected<Options, std::string> read_options(int argc, char** argv) {
  auto given = given_options(argc, argv, known_options);
  if (!given) return std::unexpected{std::move(given.error())};
  Options options;
  for (const auto& [name, value] : *given) {
    if (name == "--mission") options.mission = value;
    else if (name == "--log") options.log = value;
    else if (name == "--runtime") options.runtime = value;
    else if (name == "--mode") options.mode = value;
    else if (name == "--json") options.style = Console::Style::Json;
    else if (name == "--own-users") options.own_users = true;
    else if (name == "--screen") std::from_chars(value.data(), value.data() + value.size(), options.screen);
    else if (name == "--quiet") options.style = Console::Style::Quiet;
  }
  return options;
}

/// Null: the mission names no server, or PostgreSQL is not here.
[[nodiscard]] std::unique_ptr<Database> make_store(DatabaseStrategy strategy, const std::filesystem::path& log,
                                                   const descriptor::DatabaseUse& use) {
  if (strategy == DatabaseStrategy::Postgresql) {
    if (use.server.empty()) return nullptr;
    auto opened = open_postgresql({.connection = use.server, .log = log_name(log)});
    return opened ? std::move(*opened) : nullptr;
  }
  constexpr std::uint64_t mega = 1'000'000;
  return std::make_unique<LogStore>(strategy, log,
                                    LogLimits{.rotate_octets = use.rotate_mb * mega,
                                              .rotate_age = std::chrono::hours{use.rotate_h},
                                              .keep_octets = use.keep_mb * mega});
}

/// In force: as the mission says until a telecommand has said otherwise, to this supervisor or to one before it.
[[nodiscard]] DatabaseStrategy strategy_of(const descriptor::Mission& mission, const KeeperPage& page) {
  if (const auto noted = page.database.load(); noted != 0) return static_cast<DatabaseStrategy>(noted - 1);
  return from_text<DatabaseStrategy>(mission.database.strategy).value_or(DatabaseStrategy::Sqlite);
}

/// What was injected into simulated devices: each writes the monotonic time of what it was told beside its control socket.
[[nodiscard]] std::vector<DeviceInjection> injections_of(const descriptor::Mission& mission,
                                                         const std::filesystem::path& runtime) {
  std::vector<DeviceInjection> injections;
  for (const auto& device : mission.devices) {
    std::ifstream lines{(runtime / device.name).string() + ".injected"};
    // Its time, then what it was.
    for (std::string line; std::getline(lines, line);) {
      char* behind = nullptr;
      const Duration at{std::strtoll(line.c_str(), &behind, 10)};
      injections.push_back({TimePoint{at}, device.name, *behind == ' ' ? behind + 1 : behind});
    }
  }
  return injections;
}

/// Who asks the keeper for an end, as it notes that; 0 is nobody.
[[nodiscard]] std::string end_words(std::uint32_t number) {
  if (number == KeeperPage::end_of_time) return "--for, whose time is over";
  const char* const name = ::sigabbrev_np(static_cast<int>(number));
  return name != nullptr ? fmt::format("SIG{} (signal {})", name, number) : fmt::format("signal {}", number);
}

/// Descriptors that may wake the supervisor; follows the set of living members.
class Waker {
 public:
  explicit Waker(std::initializer_list<int> always) {
    for (const int descriptor : always)
      if (descriptor >= 0) static_cast<void>(set_.add(descriptor));
  }
  void follow(const Supervisor& supervisor, FlightLauncher& launcher) {
    std::set<int> now;
    for (const Member& member : supervisor.members()) {
      if (!member.alive()) continue;
      // A closed one ends every wait, and so does what has to wait in the channel.
      if (!member.closed_at && supervisor.reads(member)) now.insert(member.channel()->wait_descriptor());
      now.insert(launcher.wait_descriptor(member.process()));
    }
    now.erase(-1);
    for (const int old : members_)
      if (!now.contains(old)) set_.remove(old);
    for (const int fresh : now)
      if (!members_.contains(fresh)) static_cast<void>(set_.add(fresh));
    members_ = std::move(now);
  }
  void forget(int descriptor) { set_.remove(descriptor); }
  [[nodiscard]] std::span<const Ready> wait(Duration limit) {
    const auto ready = set_.wait(std::max(limit, Duration{0}));
    return ready ? *ready : std::span<const Ready>{};
  }

 private:
  WaitSet set_;
  std::set<int> members_;
};

/// An exception in it ends the process where it is thrown, with last words. On its way out it would shut down the channels, and with them
/// what another supervisor is to go on with (docs/adr/0114).
template <class Body>
auto without_unwinding(Body body) noexcept {
  return body();
}

/// Between two steps, all of which is noted: for the next supervisor as a death, and one of its own choice.
[[noreturn]] void leave_to_another(LineWriter& errors) noexcept {
  errors.say("hirosco: no memory left: the supervisor ends between two steps\n");
  errors.flush(LineWriter::last_patience);
  std::_Exit(exit_environment);
}

int serve(const descriptor::Mission& mission, const Options& options, const MakeDeployment& deploy, Inheritance& keeper,
          LineWriter& errors) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigset_t blocked = signals;
  sigaddset(&blocked, SIGUSR1);  // the guard's thread takes it
  ::pthread_sigmask(SIG_BLOCK, &blocked, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  ignore_job_control();
  const FileDescriptor signal_descriptor{::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK)};

  const bool kept = ::fcntl(keeper_descriptor, F_GETFD) >= 0;
  KeeperPage& page = keeper.page();
  const bool goes_on = keeper.goes_on();
  // First of all: their numbers are free again after that.
  auto inherited = goes_on ? StoreClient::inherited() : InheritedParts{};
  // Who has to be there before others make themselves safe waits for no ordinary work. Threads are ordinary all the same.
  if (goes_on && realtime_permitted()) static_cast<void>(set_fifo_priority(supervisor_priority));
  const SystemClock clock;
  SystemFlowFactory flows;
  const bool realtime = realtime_permitted();
  const Deployment deployment = deploy(
      {.mission = mission, .clock = clock, .flows = flows, .realtime = realtime, .own_users = options.own_users});
  if (!deployment.launcher) return exit_environment;
  FlightLauncher& launcher = *deployment.launcher;
  const auto strategy = strategy_of(mission, page);
  const auto log_path = options.log.empty() ? std::filesystem::path{mission.database.path} : options.log;
  auto log_progress = WakeEvent::create();
  auto guard_found = WakeEvent::create();
  if (!log_progress || !guard_found) {
    const Error& why = (log_progress ? guard_found : log_progress).error();
    errors.say(fmt::format("hirosco: nothing to wake the supervisor by: {} ({})\n", why.text,
                           std::strerror(static_cast<int>(why.value))));
    return exit_environment;
  }
  auto store = make_store(strategy, log_path, mission.database);
  if (!store) {
    errors.say(fmt::format("hirosco: no flight without a log: libpq.so.5 is not installed (libpq5)\n"));
    return exit_environment;
  }
  if (!launcher.keep_with(keeper.store(), mission, std::move(inherited), &page)) page.alone.store(1);
  // What is told there steers nobody's terminal and gets in nobody's way, and a screen that is gone ends nobody.
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> screen{
      options.screen >= 0 ? ::fdopen(options.screen, "w") : nullptr, close};
  Console console{mission, screen ? Console::Style::Screen : options.style, screen ? screen.get() : stdout};
  UnprovokedReactions causes{clock, console};
  const auto begun = launcher.begin(mission);
  if (!begun) {
    errors.say(fmt::format("hirosco: {} does not fly: {}\n", mission.name, begun.error()));
    return exit_environment;
  }
  if (!begun->empty()) console.told(clock.onboard(), *begun);
  ThreadedPacketLog::Options log_options;
  std::atomic<const ThreadedPacketLog*> written{nullptr};
  log_options.on_progress = [&] {
    if (const ThreadedPacketLog* of = written.load()) page.log_durable.store(of->durable());
    log_progress->notify();
  };
  log_options.number = &page.log_number;
  if (const auto run = page.log_run.load(); goes_on && run != 0) {
    log_options.resume = {OnboardTime{Duration{run}}, page.log_number.load(), page.log_durable.load()};
    log_options.resolve = [log_path, strategy](Database& database, const LogResumption& noted) {
      const LogResumption of_files = resumption_of(log_path, noted);
      return strategy == DatabaseStrategy::Postgresql ? resumption_in(database, of_files) : std::optional{of_files};
    };
  }
  ThreadedPacketLog log{clock, std::move(store), std::move(log_options)};
  written = &log;
  page.log_run.store(log.run().time_since_epoch().count());
  begin_log(log);
  const auto log_refused = [&] {
    const auto why_not = why_not_begun(log, clock, log_start_limit);
    if (why_not) errors.say(fmt::format("hirosco: no flight without a log: {} ({})\n", *why_not, log_path.string()));
    return why_not.has_value();
  };
  ThreadedValueStore values{clock, std::make_unique<SystemValueDisk>(),
                            std::filesystem::path{log_path}.replace_extension(".values")};
  ThreadedReadings readings;
  ThreadedLogReadings log_readings{reader_of(log_path, mission.database.server)};
  // The threads of log, console and values exist already: they stay ordinary.
  if (realtime) keep_code_in_memory();
  static_cast<void>(realtime ? set_fifo_priority(supervisor_priority) : ask_for_short_slices());
  EpochFile epochs{std::filesystem::path{log_path}.replace_extension(".epoch")};
  const auto first_epoch =
      goes_on ? epochs.next(clock.onboard(), page.epoch_in_use.load()) : epochs.first(clock.onboard());
  if (!first_epoch) {
    if (goes_on || !log_refused())
      errors.say(fmt::format("hirosco: {}: {}\n", epochs.path().string(), first_epoch.error().text));
    return exit_environment;
  }
  page.epoch_in_use.store(*first_epoch);  // before anybody is told it: the file may never have it
  Guard guard{
      {.clock = clock, .flows = flows, .first_epoch = *first_epoch, .notes = keeper.notes(mission), .on_finding = [&] {
         guard_found->notify();
       }}};
  auto meter = ProcessMeter::own();
  Supervisor supervisor{
      {.mission = mission,
       .platform = {.clock = clock,
                    .memory = *deployment.memory,
                    .flows = flows,
                    .realtime = realtime,
                    .wakes = true,
                    .explain = {},
                    .links = deployment.links,
                    .usage = [&meter] { return meter ? meter->look() : std::nullopt; }},
       .launcher = launcher,
       .guard = guard,
       .log = log,
       .open_database = [&](DatabaseStrategy wanted) -> std::unique_ptr<Database> {
         auto opened = make_store(wanted, log_path, mission.database);
         if (opened) page.database.store(static_cast<std::uint32_t>(wanted) + 1);
         return opened;
       },
       .observer = causes,
       .first_sequence_count = static_cast<std::uint16_t>(clock.onboard().time_since_epoch().count() % 16'384),
       .journal = keeper.journal(),
       .values = &values,
       .log_readings = &log_readings,
       .readings = &readings}};
  if (!keeper.note(supervisor.mission().texts))
    console.told(clock.onboard(),
                 "the texts of this mission are too long to be kept: who goes on for this supervisor reads its files");
  if (!realtime) console.told(clock.onboard(), "no real-time scheduling: the reduced limits hold");

  Waker waker{signal_descriptor.get(), log_progress->descriptor(), guard_found->descriptor(),
              kept ? keeper_descriptor : -1};
  KeeperWatch keeper_watch{page, kept ? KeeperWatch::Keeper::Here : KeeperWatch::Keeper::Nobody};
  const TimePoint began = keeper.flight_began(clock.now());
  TimePoint next_status = clock.now() + console.period();
  bool ends_as_a_whole = false, asked_to_end = false;
  const MemoryReserve reserve{memory_of_a_step};
  AskedStops stops{page};
  // By a signal that nobody blocks or handles: its guard has stopped all by then, and nobody else would end it, its devices and orphans.
  const auto ends_if_it_stands_still = [&] {
    if (keeper_watch.lost()) ::alarm(alone_patience_s);
  };
  // Not asked before: its disk works while all that is made. A flight goes on without a log, and a death of its supervisor changes nothing
  // in that (docs/adr/0036, 0192).
  if (!goes_on && log_refused()) return exit_environment;
  if (goes_on) {
    keeper.take_inhibits(clock);
    stops.carry_out([&](bool any) {
      supervisor.adopt(any);
      return any;
    });
    // Until its thread runs: no device is to miss its enable.
    static_cast<void>(guard.step(clock.now()));
  } else {
    supervisor.start();
  }
  const auto guard_thread = GuardShell::start(
      guard, clock, options.runtime,
      {.on_begin = [&] { keeper.watch_this_thread(); },
       .stop =
           [&] {
             stops.count();  // the keeper may have: once more harms nobody
             return stops.carry_out([&](bool) { return guard.stop_all(GuardFinding::Kind::StopAsked); });
           }});
  if (!guard_thread) {
    errors.say(fmt::format("hirosco: the guard cannot start: {} ({})\n", guard_thread.error().text,
                           guard_thread.error().value));
    launcher.kill_all();
    return exit_environment;
  }
  const auto life_watch = LifeWatch::start(guard);
  if (!life_watch) console.told(clock.onboard(), "that a process has ended is known by its handle alone");
  without_unwinding([&] {
    while (!supervisor.finished()) {
      const std::uint64_t stops_heard_of = stops.carried_out();
      const TimePoint wake = supervisor.step(clock.now());
      if (supervisor.remembers()) stops.taken(stops_heard_of);
      page.supervisor.fetch_add(1, std::memory_order_relaxed);
      static_cast<void>(keeper.note(supervisor.mission().texts));
      if (reserve.used() && !std::exchange(ends_as_a_whole, true)) {
        if (keeper_watch.here() && page.alone.load() == 0 && !asked_to_end) leave_to_another(errors);
        console.told(clock.onboard(), "no memory left: the flight ends in order");
        supervisor.request_shutdown("the supervisor, which has no memory left");
      }
      if (supervisor.commissioned()) page.commissioned.store(1, std::memory_order_relaxed);
      ends_if_it_stands_still();
      const KeeperWatch::Finding of_keeper = keeper_watch.look(clock.now());
      if (of_keeper.stop) static_cast<void>(::kill(::getpid(), SIGUSR1));  // the guard's thread takes it
      if (of_keeper.still) supervisor.keeper_stands_still();
      if (of_keeper.lost) supervisor.keeper_lost();
      if (of_keeper.end != 0) {
        supervisor.request_shutdown(end_words(of_keeper.end));
        asked_to_end = true;
      }
      waker.follow(supervisor, launcher);
      for (const Ready& ready : waker.wait(std::min(wake, next_status) - clock.now())) {
        if (ready.descriptor == keeper_descriptor && ready.hung_up) {
          waker.forget(keeper_descriptor);  // it would end every wait from now on
          keeper_watch.gone();
        }
        if (ready.descriptor == log_progress->descriptor()) log_progress->clear();
        if (ready.descriptor == guard_found->descriptor()) guard_found->clear();
        if (ready.descriptor == signal_descriptor.get()) {
          signalfd_siginfo info{};
          static_cast<void>(!::read(signal_descriptor.get(), &info, sizeof info));
          const std::uint32_t to_keeper = page.end_asked.load();
          supervisor.request_shutdown(end_words(to_keeper != 0 ? to_keeper : info.ssi_signo));
          asked_to_end = true;
        }
      }
      if (const auto why = launcher.must_end(clock.now()); why && !std::exchange(ends_as_a_whole, true)) {
        console.told(clock.onboard(), *why);
        supervisor.request_shutdown("the supervisor: " + std::string{*why});
      }
      const std::uint32_t epoch_in_use = guard.highest_epoch();
      page.epoch_in_use.store(epoch_in_use);
      epochs.keep_above(epoch_in_use);
      if (clock.now() < next_status) continue;
      next_status += console.period();
      console.show(overview_of(mission, supervisor), clock.now() - began);
    }
  });
  console.ended();
  // The keeper looks on as long as this takes, too.
  const auto wait_for_ends = [&] {
    ends_if_it_stands_still();
    for (const TimePoint limit = clock.now() + last_wait; launcher.any_running() && clock.now() < limit;) {
      page.supervisor.fetch_add(1, std::memory_order_relaxed);
      sleep_until(clock.now() + 10ms);
    }
  };
  wait_for_ends();
  launcher.kill_all();
  page.finished.store(1);
  static_cast<void>(log.flush(last_wait));
  wait_for_ends();
  if (launcher.any_running()) {
    // Whoever cannot be ended works on what stands in this function: it is not left.
    errors.say("hirosco: what cannot be ended is ended with this process\n");
    errors.flush(LineWriter::last_patience);
    std::_Exit(exit_internal);
  }
  const auto without_cause = unprovoked(causes.uncommanded(), injections_of(mission, options.runtime), mission);
  if (!without_cause.empty()) {
    errors.say(fmt::format(
        "hirosco: {} reaction{} of high severity that no fault, telecommand or scenario of this flight had caused, "
        "the first {:.3f} s after the start of the flight: hirosco log --text plan\n",
        without_cause.size(), without_cause.size() == 1 ? "" : "s", seconds(without_cause.front().at - began)));
    return exit_unprovoked;
  }
  return supervisor.succeeded() ? 0 : exit_finding;
}

int named_failures(const char* program, const descriptor::Mission& mission, const Options& options,
                   const MakeDeployment& deploy, Inheritance& keeper, LineWriter& errors) {
  const auto flight = [&] { return serve(mission, options, deploy, keeper, errors); };
  try {
    return keeper.goes_on() ? without_unwinding(flight) : flight();
  } catch (const std::bad_alloc&) {
    errors.say(fmt::format("{}: no memory left for this flight\n", program));
  } catch (const std::system_error& problem) {
    // A thread of the log or of the console that cannot be started.
    errors.say(
        fmt::format("{}: the system refuses what a flight needs (thread, descriptor): {}\n", program, problem.what()));
  }
  return exit_environment;
}

}  // namespace

int fly(int argc, char** argv, const MakeDeployment& deploy) {
  const char* const slash = std::strrchr(argv[0], '/');
  const char* const program = slash != nullptr ? slash + 1 : argv[0];
  say_last_words(program);
  set_thread_name(program);  // the system names it by the number of the descriptor that it is executed from
  const auto said = read_options(argc, argv);
  if (!said) {
    fmt::print(stderr, "{}: {} (started by 'hirosco run MISSION')\n", program, said.error());
    return exit_usage;
  }
  const Options& options = *said;
  if (options.mission.empty()) {
    fmt::print(stderr, "{}: started by 'hirosco run MISSION'\n  --mission FILE [--json|--quiet]\n", argv[0]);
    return exit_usage;
  }
  // Who goes on for another one waits for nobody who reads this, from here on.
  LineWriter errors{STDERR_FILENO};
  Inheritance keeper;
  if (!keeper.fits()) {
    errors.say(
        fmt::format("{}: the keeper of this flight is of another version: build both from one hirosco\n", program));
    return exit_environment;
  }
  const auto source = keeper.source();
  auto reading = descriptor::read_mission(options.mission, source);
  for (const auto& problem : reading.problems) errors.say(descriptor::render(problem, source, false));
  if (!reading.value) return exit_finding;
  keeper.add_kept_texts(*reading.value);
  // Where the cycles are that name none; without one named all are together, whichever it is.
  if (const auto last = ProcessorSet::of_this_thread().last(); last && descriptor::names_cores(*reading.value))
    reading.value->shared_core = static_cast<std::uint16_t>(*last);
  if (!options.mode.empty())
    if (const auto why_not = descriptor::start_in(*reading.value, options.mode)) {
      errors.say(fmt::format("{}: {}\n", argv[0], *why_not));
      return exit_usage;
    }
  return named_failures(program, *reading.value, options, deploy, keeper, errors);
}

}  // namespace hirosco::supervisor
