// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/run.hpp"

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/control/socket_channel.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "hirosco/utilities/allocation_guard.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/last_words.hpp"
#include "hirosco/utilities/os/life.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

/// Of the cycle's thread. All memory is locked, so that every octet of it is taken from the computer.
constexpr std::size_t cycle_stack_octets = std::size_t{1} << 20;

/// Real-time, but below every cycle: a busy core cannot hold up a command to stop (decision 8a). Service loops share: one that never
/// rests must not keep those of others from stepping, which would then count as hanging (hazard R18).
constexpr int service_priority = 20;
constexpr int exit_usage = 2;
constexpr int exit_environment = 3;

struct Options {
  std::string descriptor;
  std::vector<std::pair<std::string, std::string>> changes;  ///< as the mission has them
  int channel{-1};
  int vital{-1};
  int permit{-1};
  [[nodiscard]] bool complete() const { return !descriptor.empty() && channel >= 0 && vital >= 0 && permit >= 0; }
};

[[nodiscard]] int number_of(const char* text) {
  int number = -1;
  std::from_chars(text, text + std::strlen(text), number);
  return number;
}

[[nodiscard]] Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name{argv[i]};
    if (name == "--descriptor") options.descriptor = argv[i + 1];
    else if (name == "--channel") options.channel = number_of(argv[i + 1]);
    else if (name == "--vital") options.vital = number_of(argv[i + 1]);
    else if (name == "--permit") options.permit = number_of(argv[i + 1]);
    else options.changes.emplace_back(name, argv[i + 1]);
  }
  return options;
}

[[nodiscard]] Mapping map_page(SealedMemory& memory, int descriptor, Access access) {
  auto mapping = memory.map(SealedMemory::adopt(descriptor), access);
  return mapping ? std::move(*mapping) : Mapping{};
}

/// Why the pages that the supervisor handed over are not used; empty when they are.
[[nodiscard]] std::string refuse_pages(const Mapping& vital, const Mapping& permit) {
  if (vital.octets.size() < sizeof(VitalPage) || permit.octets.size() < sizeof(PermitPage))
    return "the vital or permit page cannot be mapped";
  const auto& page = *reinterpret_cast<const PermitPage*>(permit.octets.data());
  if (page.magic != page_magic) return "what should be the permit page is none";
  if (page.version != page_version)
    return fmt::format(
        "the supervisor's pages are of version {}, this program's of version {}: build both from one hirosco",
        page.version, page_version);
  return {};
}

/// By which the cycle wakes the service loop: rung once until it is heard, so that a service loop that gets no processor costs the cycle
/// one system call, not one in each cycle.
class Bell {
 public:
  [[nodiscard]] static Result<Bell> make() {
    HIROSCO_TRY_LET(auto event, WakeEvent::create());
    return Bell{std::move(event)};
  }
  [[nodiscard]] int descriptor() const noexcept { return event_.descriptor(); }
  /// Realtime: one system call that does not wait. Thread: cycle.
  void ring() noexcept {
    if (!rung_->exchange(true, std::memory_order_acq_rel)) event_.notify();
  }
  /// What was reported before the bell was rung is seen after this.  Thread: service.
  void hear() noexcept {
    event_.clear();
    static_cast<void>(rung_->exchange(false, std::memory_order_acq_rel));
  }

 private:
  explicit Bell(WakeEvent event) : event_{std::move(event)} {}
  WakeEvent event_;
  std::unique_ptr<std::atomic<bool>> rung_{std::make_unique<std::atomic<bool>>(false)};
};

/// The cycle thread: sleeps to absolute times while a cycle is wanted, rests on a semaphore otherwise.
class CycleThread {
 public:
  CycleThread(GenericSubsystem& subsystem, const Clock& clock, Bell& bell, bool realtime)
      : subsystem_{subsystem}, clock_{clock}, bell_{bell}, realtime_{realtime} {}
  [[nodiscard]] Result<> start() {
    HIROSCO_TRY_LET(thread_, Thread::start("cycle", [this] { run(); }, cycle_stack_octets));
    return ok();
  }
  void wake() { wanted_.post(); }
  void end() {
    ending_.store(true, std::memory_order_release);
    wanted_.post();
    thread_.join();
  }
  /// After end(), in executables that count: what the cycle thread took from the heap while it cycled.
  void tell_heap_uses(const char* program) const {
    if (RealtimeScope::hook_present())
      fmt::print(stderr, "{}: {} uses of the heap in {} cycles\n", program, heap_uses_, cycles_);
  }

 private:
  void run() {
    static_cast<void>(realtime_ ? pin_to_cycle_cpu() : ask_for_short_slices());
    while (!ending_.load(std::memory_order_acquire)) {
      const auto demand = subsystem_.cycle_demand();
      if (!demand.wanted) {
        subsystem_.cycle_parked(demand.ticket);
        wanted_.wait();
        continue;
      }
      if (realtime_) static_cast<void>(set_fifo_priority(demand.priority));
      cycle(demand.generation);
    }
  }

  void cycle(std::uint32_t generation) {
    const RealtimeScope no_heap;
    TimePoint planned = clock_.now() + subsystem_.cycle_demand().period;
    for (;;) {
      sleep_until(planned);
      const auto demand = subsystem_.cycle_demand();
      if (!demand.wanted || demand.generation != generation || ending_.load(std::memory_order_acquire)) break;
      planned = subsystem_.cycle_step(planned);
      if (subsystem_.has_reports()) bell_.ring();
      ++cycles_;
    }
    heap_uses_ += no_heap.count().allocations + no_heap.count().frees;
  }

  GenericSubsystem& subsystem_;
  const Clock& clock_;
  Bell& bell_;
  bool realtime_;
  Semaphore wanted_{0};
  std::atomic<bool> ending_{false};
  std::uint64_t cycles_{0};  ///< the cycle thread's until it is joined, like the next
  std::uint64_t heap_uses_{0};
  Thread thread_;
};

/// What the service loop waits for between two steps.
class ServiceWait {
 public:
  ServiceWait(const Clock& clock, int channel, Bell& bell) : clock_{clock}, channel_{channel}, bell_{bell} {
    static_cast<void>(waits_.add(channel_));
    static_cast<void>(waits_.add(bell_.descriptor()));
  }
  /// What is not read would end every wait: at real-time priority that takes the processor from who has to read us.
  void read_channel(bool reads) {
    if (reads == reading_) return;
    static_cast<void>(waits_.change(channel_, reads ? Interest::Read : Interest::Write));
    reading_ = reads;
  }
  /// Until there is something to do, `wake` at the latest.
  void wait(TimePoint wake, int authors) {
    for (;;) {
      const TimePoint now = clock_.now();
      follow(authors, now);
      const TimePoint until = authors_ < 0 && authors >= 0 ? std::min(wake, authors_from_) : wake;
      const auto ready = waits_.wait(std::max(until - now, Duration{0}));
      if (ready)
        for (const Ready& entry : *ready) take(entry);
      if (!ready || !ready->empty() || clock_.now() >= wake) return;
    }
  }

 private:
  /// The author's descriptor is looked at once in this time: one that stays readable must not keep a real-time loop from resting.
  static constexpr Duration authors_pace = 1ms;

  void follow(int authors, TimePoint now) {
    if (authors_ >= 0 && authors_ != authors) waits_.remove(std::exchange(authors_, -1));
    if (authors_ >= 0 || authors < 0 || now < authors_from_) return;
    if (waits_.add(authors)) authors_ = authors;
    else authors_from_ = now + authors_pace;
  }
  void take(const Ready& entry) {
    const int descriptor = entry.descriptor;
    if (descriptor == authors_) {
      waits_.remove(std::exchange(authors_, -1));
      authors_from_ = clock_.now() + authors_pace;
    } else if (descriptor == bell_.descriptor()) {
      bell_.hear();
    } else if (entry.hung_up) {
      // A supervisor that is gone would end every wait from now on: at real-time priority that takes the processor.
      waits_.remove(descriptor);
    }
  }

  const Clock& clock_;
  int channel_;
  Bell& bell_;
  WaitSet waits_;
  bool reading_{true};
  int authors_{-1};  ///< waited for now; -1: there is none, or not yet again
  TimePoint authors_from_{};
};

/// `program` names itself where it has to say something.
void serve(const char* program, GenericSubsystem& subsystem, const Clock& clock, const SocketChannel& channel,
           CycleThread& cycle, Bell& bell) {
  ServiceWait waits{clock, channel.wait_descriptor(), bell};
  bool cycling = false;
  bool told_version = false;
  std::uint32_t ticket = 0;
  while (!subsystem.finished()) {
    const TimePoint wake = subsystem.service_step(clock.now());
    if (const auto theirs = channel.foreign_version(); theirs && !std::exchange(told_version, true))
      fmt::print(stderr,
                 "{}: the supervisor's control channel is of version {}, this program's of version {}: build both from "
                 "one hirosco\n",
                 program, *theirs, envelope::version);
    const auto demand = subsystem.cycle_demand();
    // A cycle may be wanted and called off within one step: its thread must answer that order to rest, too.
    if ((demand.wanted && !cycling) || demand.ticket != ticket) cycle.wake();
    cycling = demand.wanted;
    ticket = demand.ticket;
    waits.read_channel(subsystem.reads());
    waits.wait(wake, subsystem.service_wake().descriptor);
  }
}

}  // namespace

int run_subsystem(int argc, char** argv, const std::function<std::unique_ptr<Subsystem>()>& make) {
  say_last_words(argv[0]);
  name_refused_calls(argv[0]);
  // A terminal or pipe that is gone takes no words any more; that must not end a subsystem.
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
  const Options options = read_options(argc, argv);
  if (!options.complete()) {
    fmt::print(stderr,
               "{}: a subsystem is started by the supervisor (hirosco run MISSION), which passes\n"
               "  --descriptor FILE --channel FD --vital FD --permit FD [--as NAME:ID] [--set PARAMETER=VALUES]\n"
               "  [--address DEVICE=ADDRESS] [--enable DEVICE=ADDRESS] [--commands NAME=ID:FILE]\n",
               argv[0]);
    return exit_usage;
  }
  const auto source = descriptor::file_system();
  auto reading = descriptor::read_subsystem(options.descriptor, source);
  for (const auto& problem : reading.problems) fmt::print(stderr, "{}", descriptor::render(problem, source, false));
  if (!reading.value) return exit_environment;
  for (const auto& [word, text] : options.changes)
    if (const auto applied = word == "--commands" ? descriptor::apply_commands(*reading.value, text, source)
                                                  : descriptor::apply_change(*reading.value, word, text);
        !applied) {
      fmt::print(stderr, "{}: {} {}: {}\n", argv[0], word, text, applied.error().text);
      return exit_environment;
    }

  SystemClock clock;
  SealedMemory memory;
  SystemFlowFactory flows;
  SocketChannel channel{FileDescriptor{options.channel}};
  const Mapping vital = map_page(memory, options.vital, Access::ReadWrite);
  const Mapping permit = map_page(memory, options.permit, Access::ReadOnly);
  if (const std::string why = refuse_pages(vital, permit); !why.empty()) {
    fmt::print(stderr, "{}: {}\n", argv[0], why);
    return exit_environment;
  }
  // Where the system has no such word, the supervisor hears of our end by our process alone.
  static_cast<void>(hold_life(reinterpret_cast<VitalPage*>(vital.octets.data())->life));
  const bool realtime = realtime_permitted();
  if (realtime) {
    static_cast<void>(lock_memory());
    static_cast<void>(set_shared_priority(service_priority));
  }
  auto meter = ProcessMeter::own();
  const Platform platform{
      .clock = clock,
      .memory = memory,
      .flows = flows,
      .realtime = realtime,
      .wakes = true,
      .explain = [](std::string_view text) { std::fputs(fmt::format("{}\n", text).c_str(), stderr); },
      .usage = [&meter]() -> std::optional<ProcessUsage> { return meter ? meter->look() : std::nullopt; }};
  const auto author = make();
  GenericSubsystem subsystem{*author,
                             std::move(*reading.value),
                             platform,
                             channel,
                             *reinterpret_cast<VitalPage*>(vital.octets.data()),
                             *reinterpret_cast<const PermitPage*>(permit.octets.data())};
  auto bell = Bell::make();
  if (!bell) {
    fmt::print(stderr, "{}: {} (errno {})\n", argv[0], bell.error().text, bell.error().value);
    return exit_environment;
  }
  CycleThread cycle{subsystem, clock, *bell, realtime};
  if (const auto started = cycle.start(); !started) {
    fmt::print(stderr, "{}: {} (errno {})\n", argv[0], started.error().text, started.error().value);
    return exit_environment;
  }
  serve(argv[0], subsystem, clock, channel, cycle, *bell);
  cycle.end();
  cycle.tell_heap_uses(argv[0]);
  return 0;
}

}  // namespace hirosco
