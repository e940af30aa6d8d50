// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/loops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hirosco/subsystem/process/cycle_rest.hpp"
#include "hirosco/utilities/allocation_guard.hpp"

namespace hirosco {
namespace {

/// To its own, or to the one that all share who name none.
Result<> pin_to(std::optional<unsigned> core) noexcept { return core ? pin_to_cpu(*core) : pin_to_cycle_cpu(); }

/// Of the cycle's thread. All memory is locked, so that every octet of it is taken from the computer.
constexpr std::size_t cycle_stack_octets = std::size_t{1} << 20;

/// What the service loop waits for between two steps.
class ServiceWait {
 public:
  ServiceWait(const Clock& clock, int channel, int room, Bell& bell)
      : clock_{clock}, channel_{channel}, room_{room}, bell_{bell} {
    static_cast<void>(waits_.add(channel_));
    static_cast<void>(waits_.add(bell_.descriptor()));
  }
  /// What is not read would end every wait: at real-time priority that takes the processor from who has to read us.
  void read_channel(bool reads) {
    if (reads == reading_) return;
    if (room_ < 0) {
      static_cast<void>(waits_.change(channel_, reads ? Interest::Read : Interest::Write));
    } else {
      waits_.remove(reads ? room_ : channel_);
      static_cast<void>(waits_.add(reads ? channel_ : room_));
    }
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
  int room_;
  Bell& bell_;
  WaitSet waits_;
  bool reading_{true};
  int authors_{-1};  ///< waited for now; -1: there is none, or not yet again
  TimePoint authors_from_{};
};

}  // namespace

bool may_spin(bool realtime, std::optional<unsigned> core) noexcept {
  if (!realtime) return false;
  ProcessorSet all = ProcessorSet::of_this_thread();
  if (core) all.add(*core);
  return all.count() > 1;
}

Result<Bell> Bell::make() {
  HIROSCO_TRY_LET(auto event, WakeEvent::create());
  return Bell{std::move(event)};
}

Result<> CycleThread::start(std::string name) {
  HIROSCO_TRY_LET(thread_, Thread::start(std::move(name), [this] { run(); }, cycle_stack_octets));
  return ok();
}

void CycleThread::end() {
  ending_.store(true, std::memory_order_release);
  wanted_.post();
  thread_.join();
}

void CycleThread::tell_heap_uses(const char* program) const {
  if (RealtimeScope::hook_present())
    fmt::print(stderr, "{}: {} uses of the heap in {} cycles\n", program, heap_uses_, cycles_);
}

void CycleThread::run() {
  if (hold_ != nullptr) hold_->enter();
  take_place();
  while (!ending_.load(std::memory_order_acquire)) {
    const auto demand = subsystem_.cycle_demand();
    if (!demand.wanted) {
      subsystem_.cycle_parked(demand.ticket);
      wanted_.wait();
      continue;
    }
    take_priority(demand.priority);
    cycle(demand.generation, demand.priority);
  }
  if (hold_ != nullptr) hold_->leave();
}

/// Where one is named it is there without real-time rights, too: the mission says so.
void CycleThread::take_place() noexcept {
  const auto named = core_ != nullptr ? core_->named : std::nullopt;
  if (realtime_ || named) static_cast<void>(pin_to(named));
  if (!realtime_) static_cast<void>(ask_for_short_slices());
  const ProcessorSet mine = ProcessorSet::of_this_thread();
  if (core_ != nullptr && mine.count() == 1)
    core_->is.store(static_cast<std::uint16_t>(*mine.last()), std::memory_order_relaxed);
}

/// Of the configuration; 0 is ordinary scheduling, whatever the one before had.
void CycleThread::take_priority(int priority) {
  if (!realtime_) return;
  static_cast<void>(priority > 0 ? set_fifo_priority(priority) : set_ordinary_scheduling());
}

void CycleThread::cycle(std::uint32_t generation, int priority) {
  const RealtimeScope no_heap;
  TimePoint planned = clock_.now() + subsystem_.cycle_demand().period;
  for (;;) {
    const auto spun_from = rest_until(planned, subsystem_.cycle_wait(), clock_);
    const auto demand = subsystem_.cycle_demand();
    if (!demand.wanted || demand.generation != generation || ending_.load(std::memory_order_acquire)) break;
    planned = subsystem_.cycle_step(planned, spun_from);
    // Another configuration may have followed without a break (adr 0096): its period is in `planned`.
    if (const int wanted = subsystem_.cycle_demand().priority; wanted != priority) {
      priority = wanted;
      take_priority(priority);
    }
    if (subsystem_.has_reports()) bell_.ring();
    ++cycles_;
  }
  heap_uses_ += no_heap.count().allocations + no_heap.count().frees;
}

Result<> OwnLoopThread::start() {
  HIROSCO_TRY_LET(
      thread_,
      Thread::start("loop." + subsystem_.own_loop(loop_).declared().name, [this] { run(); }, cycle_stack_octets));
  return ok();
}

void OwnLoopThread::end() {
  ending_.store(true, std::memory_order_release);
  subsystem_.own_loop(loop_).wake();
  thread_.join();
}

void OwnLoopThread::run() {
  if (hold_ != nullptr) hold_->enter();
  anywhere_ = ProcessorSet::of_this_thread();
  OwnLoop& loop = subsystem_.own_loop(loop_);
  TimePoint planned = clock_.now() + loop.in_force().period;
  while (!ending_.load(std::memory_order_acquire)) {
    // Another configuration may make it due sooner, or at another priority, while it rests.
    take_priority(loop.in_force().priority);
    if (!loop.rest_until(planned)) continue;
    planned = loop.step(planned);
    if (subsystem_.has_reports()) bell_.ring();
  }
  if (hold_ != nullptr) hold_->leave();
}

/// One with a priority shares the processor of its cycle, where its response is reckoned (adr 0085); one without goes anywhere.
void OwnLoopThread::take_priority(int priority) {
  if (!realtime_ || priority == priority_) return;
  // Up: priority, then processor. Down: the other way round, as behind the cycles of their processor it might not come to ask for others.
  if (priority > 0) {
    // The guard takes the right to one for a while: it stays as it is, and asks again before its next step.
    if (!set_fifo_priority(priority)) return;
    static_cast<void>(pin_to(core_));
  } else {
    static_cast<void>(anywhere_.take());
    static_cast<void>(set_ordinary_scheduling());
  }
  priority_ = priority;
}

void serve(const ServiceLoop& loop) {
  ServiceWait waits{loop.clock, loop.channel.wait_descriptor(), loop.room, loop.bell};
  const auto to_let_go = [&] { return loop.let_go != nullptr && loop.let_go->load(std::memory_order_acquire); };
  bool cycling = false;
  std::uint32_t ticket = 0;
  while (!loop.subsystem.finished() && !to_let_go()) {
    const TimePoint wake = loop.subsystem.service_step(loop.clock.now());
    if (loop.after_step) loop.after_step();
    const auto demand = loop.subsystem.cycle_demand();
    // A cycle may be wanted and called off within one step: its thread must answer that order to rest, too.
    if ((demand.wanted && !cycling) || demand.ticket != ticket) loop.cycle.wake();
    cycling = demand.wanted;
    ticket = demand.ticket;
    waits.read_channel(loop.subsystem.reads());
    if (loop.resting != nullptr) loop.resting->store(true, std::memory_order_relaxed);
    waits.wait(wake, loop.subsystem.service_wake().descriptor);
    if (loop.resting != nullptr) loop.resting->store(false, std::memory_order_relaxed);
  }
}

}  // namespace hirosco
