// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/thread_launcher.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <new>
#include <utility>

#include "hirosco/data_transfer/channel/thread_channel.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/process/loops.hpp"

namespace hirosco::supervisor {
namespace {

/// Of the service loop's thread: a process has 8 MiB, of which it keeps in memory what it touches. Here all of it is kept there.
constexpr std::size_t service_stack_octets = std::size_t{2} << 20;
/// As the end of a process that was killed, so that whoever reads a log finds one word for it.
constexpr ProcessEnd killed{true, 9};
constexpr ProcessEnd by_defect{false, 4};
constexpr std::array<std::string_view, 9> not_isolated{
    "threads of one process share their memory: who writes where it should not damages any other, the supervisor and "
    "its guard too",
    "the pages that gate actuators and the memory of links are sealed against nobody",
    "a crash of one (fault, abort, exception in a cycle) is the end of all; then the devices stop by their own "
    "watchdogs",
    "who hangs cannot be ended: it is fenced and loses its real-time priority; if it has not let go after 2 s the "
    "whole flight ends",
    "nobody is in a sandbox: files, sockets and signals of one are those of all",
    "memory_kB, shared_memory_kB, threads and descriptors that a subsystem declares stand in the books, and are "
    "counted and limited for nobody",
    "processor_percent that a subsystem declares is held against the time of its loops: a thread that its author "
    "starts is counted for nobody",
    "cores that the mission names hold for their loops; a thread that goes elsewhere by itself is found by nobody",
    "the supervisor cannot be lost alone: its end is the end of all",
};

/// A page in memory of its own, constructed in place.
template <class Page>
[[nodiscard]] Result<Mapping> make_page(MemoryProvider& memory, const char* name) {
  HIROSCO_TRY_LET(const MemoryHandle handle, memory.create(name, sizeof(Page)));
  HIROSCO_TRY_LET(Mapping mapping, memory.map(handle, Access::ReadWrite));
  ::new (mapping.octets.data()) Page;
  return mapping;
}

}  // namespace

/// One subsystem: what its threads work on, and what others may ask of them.
struct ThreadLauncher::Member {
  Member(const descriptor::MissionSubsystem& what, Bell rung) : described{what}, bell{std::move(rung)} {
    for (std::size_t i = 0; i < what.subsystem.service_loops.size(); ++i)
      loops.push_back(std::make_unique<ThreadHold>());
  }

  void run() noexcept;
  void fly();
  /// Fences are the guard's; this is all else that can be done to a thread.
  void tell_to_let_go(TimePoint now) noexcept {
    take_loops_realtime();
    static_cast<void>(cycle.take_realtime());
    // Zero says that nobody was told yet, and no clock of a flight reads it.
    std::int64_t none = 0;
    static_cast<void>(told_at_ns.compare_exchange_strong(none, now.time_since_epoch().count()));
    let_go.store(true, std::memory_order_release);
    bell.ring();
  }

  void take_loops_realtime() noexcept {
    static_cast<void>(service.take_realtime());
    for (const auto& loop : loops) static_cast<void>(loop->take_realtime());
  }

  /// Of its loops. A thread that its author starts himself is known to nobody: the system does not tell who started it.
  [[nodiscard]] Duration processor_time() noexcept {
    Duration all = service.processor_time() + cycle.processor_time();
    for (const auto& loop : loops) all += loop->processor_time();
    return all;
  }
  /// The rest is of the whole process.
  [[nodiscard]] ProcessUsage usage() noexcept {
    return {.processor = processor_time(), .cycle_core = core.is.load(std::memory_order_relaxed)};
  }

  const descriptor::MissionSubsystem
      described;  ///< as it was launched; that of the mission may be read again meanwhile
  const Parts* parts{nullptr};
  MemoryProvider* memory{nullptr};
  std::function<std::unique_ptr<Subsystem>()> make;
  std::unique_ptr<ThreadChannel> channel;
  Mapping vital, permit;
  Bell bell;
  std::optional<WakeEvent> gone;  ///< readable when it has ended
  ThreadHold service, cycle;
  std::vector<std::unique_ptr<ThreadHold>> loops;  ///< of services of its own (adr 0096)
  CycleCore core{.named = described.cores.cycle};
  std::atomic<bool> let_go{false};
  std::atomic<bool> resting{false};
  std::atomic<std::int64_t> told_at_ns{0};
  ProcessEnd end{};  ///< valid from `ended` on
  std::atomic<bool> ended{false};
  Thread thread;
};

void ThreadLauncher::Member::run() noexcept {
  service.enter();
  const auto say = [&](const char* what) {
    if (parts->explain) parts->explain(described.subsystem.name + ": " + what);
  };
  try {
    fly();
    end = let_go.load() ? killed : ProcessEnd{};
  } catch (const std::exception& problem) {
    end = by_defect;
    say(problem.what());
  } catch (...) {
    end = by_defect;
    say("an exception without words");
  }
  service.leave();
  channel.reset();  // now the supervisor reads that nobody is there any more
  ended.store(true, std::memory_order_release);
  gone->notify();
}

void ThreadLauncher::Member::fly() {
  // Whatever it starts begins there; its cycle goes from there to its own.
  if (!described.cores.services.empty()) static_cast<void>(ProcessorSet::of(described.cores.services).take());
  if (parts->realtime) static_cast<void>(set_shared_priority(service_loop_priority));
  else static_cast<void>(ask_for_short_slices());
  const Platform platform{
      .clock = parts->clock,
      .memory = *memory,
      .flows = parts->flows,
      .realtime = parts->realtime,
      .precise = may_spin(parts->realtime, core.named),
      .wakes = true,
      .explain =
          [this](std::string_view text) {
            if (parts->explain) parts->explain(described.subsystem.name + ": " + std::string{text});
          },
      .links = parts->links,
      .usage = [this]() -> std::optional<ProcessUsage> { return usage(); },
      .read_again = [begun = described.subsystem, changes = descriptor::changes_of(described)](
                        std::string_view text) { return descriptor::read_again(begun, text, changes); }};
  const auto author = make();
  if (!author) throw std::bad_alloc{};
  GenericSubsystem subsystem{*author,
                             described.subsystem,
                             platform,
                             *channel,
                             *reinterpret_cast<VitalPage*>(vital.octets.data()),
                             *reinterpret_cast<const PermitPage*>(permit.octets.data())};
  CycleThread cycles{subsystem, parts->clock, bell, parts->realtime, &cycle, &core};
  std::vector<std::unique_ptr<OwnLoopThread>> own_loops;
  // Whatever leaves this function, the threads are joined first: they work on what stands here.
  struct Joined {
    CycleThread& cycle;
    std::vector<std::unique_ptr<OwnLoopThread>>& loops;
    ~Joined() {
      cycle.end();
      for (const auto& loop : loops) loop->end();
    }
  } const joined{cycles, own_loops};
  const auto or_end = [&](const Result<>& started) {
    if (started) return;
    if (parts->explain) parts->explain(described.subsystem.name + ": " + started.error().text);
    throw std::bad_alloc{};
  };
  or_end(cycles.start(described.subsystem.name + " cycle"));
  for (std::size_t i = 0; i < std::min(subsystem.own_loops(), loops.size()); ++i) {
    own_loops.push_back(
        std::make_unique<OwnLoopThread>(subsystem, i, parts->clock, bell, parts->realtime, loops[i].get(), core.named));
    or_end(own_loops.back()->start());
  }
  serve({.subsystem = subsystem,
         .clock = parts->clock,
         .channel = *channel,
         .cycle = cycles,
         .bell = bell,
         .room = channel->room_descriptor(),
         .let_go = &let_go,
         .resting = &resting});
}

/// Realtime: some system calls. Takes nothing from the heap.
class ThreadLauncher::Grip final : public ProcessGrip {
 public:
  Grip(std::shared_ptr<Member> member, const Clock& clock) : member_{std::move(member)}, clock_{clock} {}
  void take_realtime() noexcept override {
    static_cast<void>(member_->cycle.take_realtime());
    member_->take_loops_realtime();
  }
  void take_loops_realtime() noexcept override { member_->take_loops_realtime(); }
  void give_realtime() noexcept override {
    if (member_->let_go.load(std::memory_order_acquire)) return;
    member_->service.give_realtime();
    for (const auto& loop : member_->loops) loop->give_realtime();
    member_->cycle.give_realtime();
  }
  LoopTime loop_time() noexcept override {
    const Duration service = member_->service.processor_time();
    // One that neither rests nor has had the processor may also wait for something in its author's code. It is taken for one that wants
    // the processor only where another one has had it all the time, too.
    return {.service = service,
            .realtime = member_->service.has_realtime() ? service : Duration{0},
            .runnable = !member_->resting.load(std::memory_order_relaxed)};
  }
  Duration processor_time() noexcept override { return member_->processor_time(); }
  void kill() noexcept override { member_->tell_to_let_go(clock_.now()); }

 private:
  std::shared_ptr<Member> member_;
  const Clock& clock_;
};

ThreadLauncher::ThreadLauncher(Parts parts) : parts_{std::move(parts)} {}

ThreadLauncher::~ThreadLauncher() {
  kill_all();
  for (auto& [number, member] : members_) member->thread.join();
}

std::expected<std::string, std::string> ThreadLauncher::begin(const descriptor::Mission& mission) {
  // A manifest says which files may be executed, and nothing is executed here: it would be in force for nobody.
  if (mission.manifest)
    return std::unexpected{"its manifest " + mission.manifest->file.string() +
                           " lists programs, and threads are none: it flies as processes only"};
  for (const auto& member : mission.subsystems)
    if (!parts_.makers.contains(member.executable))
      return std::unexpected{"nobody here makes " + member.subsystem.name + " (" + member.executable + ")"};
  users_ = mission.users;
  return std::to_string(mission.subsystems.size()) + " subsystems are threads of one process";
}

Result<LaunchedSubsystem> ThreadLauncher::launch(const descriptor::MissionSubsystem& subsystem) {
  const auto made = parts_.makers.find(subsystem.executable);
  if (made == parts_.makers.end()) return fail(ErrorCode::NotFound, "nobody here makes this subsystem");
  // Two that move the same devices are worse than none.
  for (const auto& [number, earlier] : members_)
    if (earlier->described.subsystem.name == subsystem.subsystem.name &&
        !earlier->ended.load(std::memory_order_acquire))
      return fail(ErrorCode::Unavailable, "its earlier threads have not let go, and cannot be ended");
  HIROSCO_TRY_LET(auto bell, Bell::make());
  HIROSCO_TRY_LET(auto gone, WakeEvent::create());
  HIROSCO_TRY_LET(auto ends, ThreadChannel::make_pair(
                                 subsystem.subsystem.resources.channel_kb.value_or(ThreadChannel::default_kb)));
  HIROSCO_TRY_LET(Mapping vital, make_page<VitalPage>(memory_, "hirosco-vital"));
  HIROSCO_TRY_LET(Mapping permit, make_page<PermitPage>(memory_, "hirosco-permit"));
  // Its counts go on where those of the threads before it ended (decision 8b).
  auto& before = vital_[subsystem.subsystem.name];
  if (before.octets.size() >= sizeof(VitalPage))
    reinterpret_cast<VitalPage*>(vital.octets.data())->counters =
        reinterpret_cast<const VitalPage*>(before.octets.data())->counters;
  before = vital;
  auto member = std::make_shared<Member>(subsystem, std::move(bell));
  member->parts = &parts_;
  member->memory = &memory_;
  member->make = made->second;
  member->channel = std::move(ends.second);
  member->vital = vital;
  member->permit = permit;
  member->gone.emplace(std::move(gone));
  HIROSCO_TRY_LET(member->thread,
                  Thread::start(subsystem.subsystem.name, [raw = member.get()] { raw->run(); }, service_stack_octets));
  LaunchedSubsystem launched;
  launched.vital = std::move(vital);
  launched.permit = std::move(permit);
  launched.port = std::make_unique<LocalMemberPort>(std::move(ends.first), launched.vital, launched.permit);
  launched.process = next_++;
  launched.grip = std::make_shared<Grip>(member, parts_.clock);
  members_.emplace(launched.process, std::move(member));
  return launched;
}

std::optional<ProcessEnd> ThreadLauncher::ended(std::uint32_t process) {
  const auto found = members_.find(process);
  if (found == members_.end()) return ProcessEnd{};
  if (!found->second->ended.load(std::memory_order_acquire)) return std::nullopt;
  const ProcessEnd end = found->second->end;
  found->second->thread.join();
  members_.erase(found);
  return end;
}

void ThreadLauncher::kill(std::uint32_t process) {
  if (const auto found = members_.find(process); found != members_.end())
    found->second->tell_to_let_go(parts_.clock.now());
}

void ThreadLauncher::kill_all() {
  for (auto& [number, member] : members_) member->tell_to_let_go(parts_.clock.now());
}

bool ThreadLauncher::any_running() {
  for (auto entry = members_.begin(); entry != members_.end();) {
    const bool gone = entry->second->ended.load(std::memory_order_acquire);
    if (gone) entry->second->thread.join();
    entry = gone ? members_.erase(entry) : std::next(entry);
  }
  return !members_.empty();
}

int ThreadLauncher::wait_descriptor(std::uint32_t process) {
  const auto found = members_.find(process);
  return found != members_.end() ? found->second->gone->descriptor() : -1;
}

std::optional<std::string> ThreadLauncher::must_end(TimePoint now) {
  for (const auto& [number, member] : members_) {
    const std::int64_t told = member->told_at_ns.load(std::memory_order_relaxed);
    if (told == 0 || member->ended.load(std::memory_order_acquire)) continue;
    if (now - TimePoint{Duration{told}} >= patience)
      return member->described.subsystem.name + " does not let go, and a thread cannot be ended: the whole flight ends";
  }
  return std::nullopt;
}

std::optional<ProcessUsage> ThreadLauncher::usage(std::uint32_t process) noexcept {
  const auto found = members_.find(process);
  if (found == members_.end() || found->second->ended.load(std::memory_order_acquire)) return std::nullopt;
  return found->second->usage();
}

std::vector<std::string> ThreadLauncher::isolation_lacks() const {
  std::vector<std::string> lacks(not_isolated.begin(), not_isolated.end());
  if (users_)
    lacks.push_back("users " + std::to_string(users_->first) + "-" + std::to_string(users_->last) +
                    " that the mission names are nobody's: threads of one process are all of one user");
  return lacks;
}

}  // namespace hirosco::supervisor
