// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/thread_hold.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

/// What drives a subsystem in real time, whether it is a process or threads of one: its two loops over the operating system's clock.
namespace hirosco {

/// Of every service loop. Real-time, but below every cycle: a busy core cannot hold up a command to stop (decision 8a). Service loops
/// share: one that never rests must not keep those of others from stepping, which would then count as hanging (hazard R18).
inline constexpr int service_loop_priority = 20;

/// Whether a cycle may spin (docs/adr/0104): with the right to go before others, and where who serves has another processor. `core`: its
/// own, where its mission names one. Thread: the service loop's.
[[nodiscard]] bool may_spin(bool realtime, std::optional<unsigned> core) noexcept;

/// Where a cycle goes.
struct CycleCore {
  std::optional<unsigned> named{};  ///< by its mission (docs/adr/0234)
  std::atomic<std::uint16_t> is{ProcessUsage::no_core};  ///< where it is, as the system tells; written by its thread
};

/// By which the cycle, or somebody outside, wakes the service loop: rung once until it is heard, so that a service loop that gets no
/// processor costs the cycle one system call, not one in each cycle.
class Bell {
 public:
  [[nodiscard]] static Result<Bell> make();
  [[nodiscard]] int descriptor() const noexcept { return event_.descriptor(); }
  /// Realtime: one system call that does not wait. Thread: any.
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

/// The cycle thread: sleeps to absolute times, or until a sample starts its cycle, while a cycle is wanted, rests on a semaphore otherwise.
class CycleThread {
 public:
  /// All must outlive end(). `hold` (may be null): how others reach the thread. `core` (may be null): where it goes.
  CycleThread(GenericSubsystem& subsystem, const Clock& clock, Bell& bell, bool realtime, ThreadHold* hold = nullptr,
              CycleCore* core = nullptr)
      : subsystem_{subsystem}, clock_{clock}, bell_{bell}, realtime_{realtime}, hold_{hold}, core_{core} {}
  /// `name` shows in the tools of the operating system.
  [[nodiscard]] Result<> start(std::string name);
  void wake() { wanted_.post(); }
  /// Returns when its last cycle has.
  void end();
  /// After end(), in executables that count: what the cycle thread took from the heap while it cycled.
  void tell_heap_uses(const char* program) const;

 private:
  void run();
  void take_place() noexcept;
  void take_priority(int priority);
  void cycle(std::uint32_t generation, int priority);

  GenericSubsystem& subsystem_;
  const Clock& clock_;
  Bell& bell_;
  bool realtime_;
  ThreadHold* hold_;
  CycleCore* core_;
  Semaphore wanted_{0};
  std::atomic<bool> ending_{false};
  std::uint64_t cycles_{0};  ///< the cycle thread's until it is joined, like the next
  std::uint64_t heap_uses_{0};
  Thread thread_;
};

/// A loop of services of its own (adr 0096), in its thread as long as the subsystem lives. Its period and priority are those of the
/// configuration in force (adr 0207).
class OwnLoopThread {
 public:
  OwnLoopThread(GenericSubsystem& subsystem, std::size_t loop, const Clock& clock, Bell& bell, bool realtime,
                ThreadHold* hold = nullptr, std::optional<unsigned> core = std::nullopt)
      : subsystem_{subsystem}, loop_{loop}, clock_{clock}, bell_{bell}, realtime_{realtime}, hold_{hold}, core_{core} {}
  /// The guard tells the cycle's thread by its name: no loop has the same.
  [[nodiscard]] Result<> start();
  void end();

 private:
  void run();
  void take_priority(int priority);

  GenericSubsystem& subsystem_;
  std::size_t loop_;
  const Clock& clock_;
  Bell& bell_;
  bool realtime_;
  ThreadHold* hold_;
  std::optional<unsigned> core_;
  int priority_{0};  ///< that it has; the thread's own, like the next
  ProcessorSet anywhere_{};
  std::atomic<bool> ending_{false};
  Thread thread_;
};

/// What the service loop goes by.
struct ServiceLoop {
  GenericSubsystem& subsystem;
  const Clock& clock;
  const Channel& channel;
  CycleThread& cycle;
  Bell& bell;
  /// Readable when the supervisor has taken what there was no room for; -1: the channel's own descriptor is writable then.
  int room{-1};
  /// Called after each step.
  std::function<void()> after_step{};
  /// What somebody outside may say: the loop returns at its next step. Null: nobody.
  const std::atomic<bool>* let_go{nullptr};
  /// True while the loop waits, for who asks whether it wants the processor. Null: nobody asks.
  std::atomic<bool>* resting{nullptr};
};
/// Runs until the subsystem has finished, or is to let go.  Thread: the service loop's.
void serve(const ServiceLoop& loop);

}  // namespace hirosco
