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
#include <string>
#include <string_view>
#include <utility>

#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/line_writer.hpp"
#include "hirosco/utilities/os/linux/memfd.hpp"
#include "hirosco/utilities/os/shared_memory.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/keeper/inhibit_bridge.hpp"
#include "supervisor/keeper/job_control.hpp"
#include "supervisor/keeper/kept_store.hpp"
#include "supervisor/keeper/service_notice.hpp"

namespace hirosco::supervisor {
namespace {

constexpr int exit_environment = 3;
constexpr int exit_internal = 4;
constexpr Duration device_grace = 1s;
/// A terminal or tool sends one wish by several ways: to the process and to its group.
constexpr Duration one_wish = 1s;
/// What a subsystem may take to make itself safe and end once the supervisor is gone.
constexpr Duration orphan_grace = 5s;
/// How often it looks; signals wake it.
constexpr Duration look = 100ms;
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
void end_orphans(const std::vector<Process>& devices, int beside, const sigset_t& set, const Clock& clock) {
  const TimePoint limit = clock.now() + orphan_grace;
  for (bool left = true; left;) {
    left = false;
    each_child([&](int pid) {
      if (pid == beside || std::ranges::find(devices, pid, &Process::pid) != devices.end()) return;
      if (::waitpid(pid, nullptr, WNOHANG) != 0) return;  // it has ended and is reaped
      left = true;
      if (clock.now() > limit) ::kill(pid, SIGKILL);  // ours until it is reaped: nobody else has its number
    });
    if (left) static_cast<void>(next_signal(set, 20ms));
  }
}

/// Nothing ends here without a word of what the system refused.
int refused(LineWriter& errors, std::string_view what, std::int64_t number) {
  errors.say("hirosco: " + std::string{what} + ": " + std::strerror(static_cast<int>(number)) + "\n");
  return exit_environment;
}

/// What is shared with the supervisors of this flight.
struct Shared {
  FileDescriptor watched, held;  ///< a pipe: its end tells the supervisor that the keeper is gone
  FileDescriptor flight_watched, flight_held;  ///< another: its end tells devices that the supervisor is, too
  FileDescriptor page_memory, journal, texts;
  MappedMemory mapped;
  FileDescriptor to_store;
  std::optional<KeptStore> store;
  [[nodiscard]] KeeperPage& page() const noexcept { return *reinterpret_cast<KeeperPage*>(mapped.octets().data()); }
};

/// 0, or the exit code.
[[nodiscard]] int prepare(Shared& shared, LineWriter& errors) {
  for (const auto& [watched, held] :
       {std::pair{&shared.watched, &shared.held}, std::pair{&shared.flight_watched, &shared.flight_held}}) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return refused(errors, "no pipe to watch over the flight", errno);
    watched->reset(ends[0]);
    held->reset(ends[1]);
  }
  const auto memory = [](const char* name, std::size_t octets, FileDescriptor& into) -> Result<> {
    HIROSCO_TRY_LET(into, memfd::create(name, octets));
    return ok();
  };
  auto made = memory("hirosco-keeper", sizeof(KeeperPage), shared.page_memory);
  if (made) made = memory("hirosco-journal", journal_octets, shared.journal);
  if (made) made = memory("hirosco-texts", texts_octets, shared.texts);
  if (!made) return refused(errors, "no memory to watch over the flight", made.error().value);
  auto mapped = MappedMemory::map(shared.page_memory.get(), sizeof(KeeperPage), MapMode::ReadWrite);
  if (!mapped) return refused(errors, "no memory to watch over the flight", mapped.error().value);
  shared.mapped = std::move(*mapped);
  ::new (shared.mapped.octets().data()) KeeperPage;
  auto socket = KeptStore::make_socket();
  if (!socket) return refused(errors, "no socket to keep the flight by", socket.error().value);
  shared.store.emplace(std::move(socket->first), &shared.page());
  shared.to_store = std::move(socket->second);
  return 0;
}

/// A flight with its supervisors, one after the other.
class Flight {
 public:
  Flight(KeeperPlan& plan, Shared& shared, const std::vector<Process>& devices, const sigset_t& signals,
         const ServiceNotice& notice, LineWriter& errors)
      : plan_{plan},
        notice_{notice},
        errors_{errors},
        devices_{devices},
        shared_{shared},
        page_{shared.page()},
        signals_{signals},
        started_{clock_.now()},
        bridge_{page_, flows_, std::move(plan.inhibits)} {
    // The supervisor ends it where this process cannot any more; one that would last for longer than time does not.
    if (plan.run_for && *plan.run_for < TimePoint::max() - started_)
      page_.ends_at.store((started_ + *plan.run_for).time_since_epoch().count());
  }

  [[nodiscard]] Result<> start() {
    page_.starts.fetch_add(1);
    page_.supervisor.store(0);  // it is watched from its first step on
    ProcessStart start = plan_.supervisor;
    start.inherited.insert(start.inherited.end(), {{shared_.watched.get(), keeper_descriptor},
                                                   {shared_.page_memory.get(), keeper_page_descriptor},
                                                   {shared_.to_store.get(), keeper_store_descriptor},
                                                   {shared_.journal.get(), keeper_journal_descriptor},
                                                   {shared_.texts.get(), keeper_texts_descriptor},
                                                   {shared_.flight_held.get(), flight_held_descriptor}});
    shared_.store->pass_on(start.inherited);
    // It is asked for its end before it can listen, too.
    start.blocked = {SIGTERM, SIGINT, SIGUSR1};
    HIROSCO_TRY_LET(Process process, Process::spawn(start));
    supervisor_.emplace(std::move(process));
    // Of the first one nothing flies until it has begun; its way there may take a disk's time.
    progress_ =
        page_.starts.load() > 1 ? Progress{supervisor_patience, successor_patience} : Progress{supervisor_patience};
    began_ = clock_.now();
    bridge_.watch(supervisor_->pid());
    if (asked_) static_cast<void>(supervisor_->send_signal(SIGTERM));
    return ok();
  }

  /// Until the last supervisor has ended; the exit code.
  [[nodiscard]] int fly() {
    for (;;) {
      page_.keeper.fetch_add(1, std::memory_order_relaxed);
      shared_.store->take();
      reap();
      tell_manager();
      if (const auto code = look_after()) return *code;
      take_signal(next_signal(signals_, revive_at_ ? 1ms : look));
    }
  }

 private:
  /// The exit code, once no supervisor goes on.
  [[nodiscard]] std::optional<int> look_after() {
    const TimePoint now = clock_.now();
    if (revive_at_) {
      if (now < *revive_at_) return std::nullopt;
      revive_at_.reset();
      const auto started = start();
      if (started) return std::nullopt;
      // What the system refuses now, as what it ended the one before by, it may have again in a moment.
      const auto pause = asked_ ? std::nullopt : revivals_.next(Duration{0});
      errors_.say(std::string{"hirosco: another supervisor cannot be started"} +
                  (pause ? ", it is tried again: " : ": ") + std::strerror(static_cast<int>(started.error().value)) +
                  "\n");
      if (!pause) return exit_internal;
      revive_at_ = now + *pause;
      return std::nullopt;
    }
    const auto end = supervisor_->poll();
    if (end && *end) return ended(**end, now);
    // One that ends flushes its log, which may take a disk's time: nobody goes on for it.
    if (page_.finished.load() != 0 && !std::exchange(ends_, true)) progress_ = Progress{ending_patience};
    const bool still = progress_.stands_still(page_.supervisor.load(std::memory_order_relaxed), now);
    if ((!still && !stopped()) || killed_) return std::nullopt;
    killed_ = true;
    static_cast<void>(supervisor_->send_signal(SIGKILL));
    errors_.say("hirosco: the supervisor stands still and is ended\n");
    return std::nullopt;
  }

  [[nodiscard]] std::optional<int> ended(const ExitStatus& end, TimePoint now) {
    const bool in_order = page_.finished.load() != 0;
    const bool began = page_.starts.load() > 1 || page_.supervisor.load() != 0;
    const int code = end.kind == ExitStatus::Kind::Exited ? end.value : exit_internal;
    const bool alone = page_.alone.load() != 0;
    const Duration lived = page_.supervisor.load() != 0 ? now - began_ : Duration{0};
    const auto pause = in_order || asked_ || alone || !began ? std::nullopt : revivals_.next(lived);
    if (!pause) return code == 0 && !in_order ? exit_internal : code;
    bridge_.begin();
    shared_.store->take();
    killed_ = false;
    revive_at_ = now + *pause;
    errors_.say("hirosco: the supervisor has died; another one goes on\n");
    return std::nullopt;
  }

  /// Subsystems whose supervisor died have us for their parent: how they end nobody else is told.
  void reap() {
    if (page_.starts.load() < 2) return;
    each_child([&](int pid) {
      const bool ours = std::ranges::find(devices_, pid, &Process::pid) != devices_.end();
      if (ours || pid == plan_.beside || pid == supervisor_->pid()) return;
      siginfo_t info{};
      const bool seen = ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0;
      if (!seen || info.si_pid == 0 || collect(pid) != Collection::Begun) return;
      const int signalled = info.si_code == CLD_EXITED ? 0 : static_cast<int>(ended_by_signal);
      const int how = signalled + info.si_status;
      page_.tell_end(static_cast<std::uint32_t>(pid), static_cast<std::uint32_t>(how));
    });
  }

  /// Once each.
  void tell_manager() {
    if (!told_ready_ && page_.commissioned.load(std::memory_order_relaxed) != 0) {
      told_ready_ = true;
      notice_.ready();
    }
    if (told_end_ || (!asked_ && page_.finished.load() == 0)) return;
    told_end_ = true;
    notice_.ends();
  }

  /// By SIGSTOP: it neither steps nor guards.
  [[nodiscard]] bool stopped() const noexcept {
    siginfo_t info{};
    return ::waitid(P_PIDFD, static_cast<id_t>(supervisor_->handle().get()), &info, WSTOPPED | WNOHANG | WNOWAIT) ==
               0 &&
           info.si_pid != 0;
  }

  void take_signal(int number) {
    const TimePoint now = clock_.now();
    if (number == SIGUSR1) stop_all();
    const bool interrupted = number == SIGINT || number == SIGTERM || number == SIGHUP;
    const bool over = plan_.run_for && !asked_ && now - started_ >= *plan_.run_for;
    const bool overdue = asked_ && now - asked_at_ > supervisor_grace;
    const bool same_wish = asked_ && interrupted && now - asked_at_ < one_wish;
    if (same_wish || (!interrupted && !over && !overdue)) return;
    if (!asked_) page_.end_asked.store(interrupted ? static_cast<std::uint32_t>(number) : KeeperPage::end_of_time);
    // The first wish is for an orderly end, the second for an end; so is one that is not fulfilled in time.
    static_cast<void>(supervisor_->send_signal(asked_ ? SIGKILL : SIGTERM));
    if (!asked_) asked_at_ = now;
    asked_ = true;
    bridge_.nobody_goes_on();
  }

  /// Its guard stops everything; where there is none now, nothing is enabled any more, and the next one carries it out.
  void stop_all() {
    page_.stops_asked.fetch_add(1);
    bridge_.stop();
    static_cast<void>(supervisor_->send_signal(SIGUSR1));
  }

  const SystemClock clock_;
  KeeperPlan& plan_;
  const ServiceNotice& notice_;
  LineWriter& errors_;
  bool told_ready_{false}, told_end_{false};
  const std::vector<Process>& devices_;
  Shared& shared_;
  KeeperPage& page_;
  const sigset_t& signals_;
  TimePoint started_;
  SystemFlowFactory flows_;
  InhibitBridge bridge_;
  std::optional<Process> supervisor_;
  TimePoint began_{};
  Progress progress_{supervisor_patience};
  bool ends_{false};  ///< the supervisor, by itself
  Revivals revivals_;
  std::optional<TimePoint> revive_at_;  ///< there is no supervisor now
  bool killed_{false};
  bool asked_{false};
  TimePoint asked_at_{};
};

}  // namespace

int keep(KeeperPlan plan) {
  const SystemClock clock;
  const sigset_t set = handled_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  ignore_job_control();
  ::signal(SIGPIPE, SIG_IGN);
  // Nothing in here waits for who reads it: what stands still there, or is gone, is nobody's of the flight.
  LineWriter errors{STDERR_FILENO};
  ::prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0);
  const ServiceNotice notice = ServiceNotice::take();  // before anybody is started
  // Before it has real time, and while a thread can be refused in words.
  if (const auto begun = begin_collecting(); !begun) return refused(errors, begun.error().text, begun.error().value);
  Shared shared;
  if (const int code = prepare(shared, errors); code != 0) return code;

  std::vector<Process> devices;
  devices.reserve(plan.devices.size());
  for (ProcessStart& start : plan.devices) {
    // Its end tells a device that keeper and supervisor are gone, however that came about: nobody else would end it.
    start.inherited.push_back({shared.flight_watched.get(), STDIN_FILENO});
    auto device = Process::spawn(start);
    if (!device) {
      end_devices(devices, set, clock);
      return refused(errors, "cannot start " + start.executable, device.error().value);
    }
    devices.push_back(std::move(*device));
  }
  static_cast<void>(set_fifo_priority(keeper_priority));
  int code = 0;
  {
    Flight flight{plan, shared, devices, set, notice, errors};
    if (const auto started = flight.start(); !started)
      code = refused(errors, "cannot start " + plan.supervisor.executable, started.error().value);
    else code = flight.fly();
  }
  static_cast<void>(set_ordinary_scheduling());
  shared.store->clear();
  end_orphans(devices, plan.beside, set, clock);
  end_devices(devices, set, clock);
  return code;
}

}  // namespace hirosco::supervisor
