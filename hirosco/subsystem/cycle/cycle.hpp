// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/parameter/write_queue.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/subsystem/cycle/actuator_gate.hpp"
#include "hirosco/subsystem/cycle/bumpless_change.hpp"
#include "hirosco/subsystem/cycle/control_state.hpp"
#include "hirosco/subsystem/cycle/cycle_inputs.hpp"
#include "hirosco/subsystem/cycle/cycle_meter.hpp"
#include "hirosco/subsystem/cycle/cycle_pace.hpp"
#include "hirosco/subsystem/cycle/cycle_plan.hpp"
#include "hirosco/subsystem/cycle/device_inputs.hpp"
#include "hirosco/subsystem/cycle/loop_rings.hpp"
#include "hirosco/subsystem/cycle/own_writes.hpp"
#include "hirosco/subsystem/cycle/permit_watch.hpp"
#include "hirosco/subsystem/cycle/realtime_watch.hpp"
#include "hirosco/subsystem/cycle/reconfiguration.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"
#include "hirosco/subsystem/cycle/self_test_run.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

namespace hirosco {

/// The cycle of a subsystem (architecture, rule 1): reads links and devices, runs the state's node, writes devices and links
/// as the actuators' gate lets them, samples housekeeping. Composes what does each of these and steps it; takes commands and enters states
/// (docs/adr/0163).
class CycleLoop final : private pus::SampleSource {
 public:
  struct Parts {
    Subsystem& author;
    const descriptor::SubsystemDescriptor& descriptor;
    const Clock& clock;
    Dictionary& dictionary;
    WriteQueue& writes;
    LoopRings& rings;
    VitalPage& vital;
    const PermitPage& permit;  ///< to begin with
    bool realtime;
    bool precise;  ///< one that asks for it may spin until it is due
    const ResourceMeter& resources;
    const LoopMeter& loops;
  };
  explicit CycleLoop(const Parts& parts);

  // --- service loop, while the cycle rests ------------------------------------------------------------------------
  void prepare(CyclePlan plan);
  void release();
  [[nodiscard]] CyclePlan& plan() noexcept { return plan_; }
  /// Of each function of the descriptor; empty: nobody has introduced it.
  [[nodiscard]] std::vector<FunctionHandler>& functions() noexcept { return functions_; }

  // --- service loop -----------------------------------------------------------------------------------------------
  /// The configuration that the next cycle works by, after prepare().  Realtime: wait-free. Thread: any.
  [[nodiscard]] const descriptor::Configuration& in_force() const noexcept {
    return *in_force_.load(std::memory_order_acquire);
  }
  [[nodiscard]] const DeviceInputs& device_inputs() const noexcept { return device_inputs_; }
  [[nodiscard]] PermitWatch& permit() noexcept { return permit_; }
  /// Whether the author's self test has passed in this configuration, and nothing has voided it.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool self_test_passed() const noexcept { return self_test_.passed(); }
  /// Whether the author's node wrote this parameter in the newest cycle: what anybody else writes would not last.
  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] bool writes_itself(std::size_t parameter) const noexcept { return own_writes_.has(parameter); }
  /// What the service loop has used of the heap, for HEAP_USES.  Realtime: wait-free. Thread: any.
  void note_service_heap(std::uint64_t uses) noexcept { meter_.note_service_heap(uses); }

  // --- parameters -------------------------------------------------------------------------------------------------
  [[nodiscard]] Parameter<CycleStatistics>& statistics() noexcept { return meter_.statistics(); }
  [[nodiscard]] Parameter<CycleTimes>& times() noexcept { return meter_.times(); }
  [[nodiscard]] Parameter<CycleBudget>& budget() noexcept { return meter_.budget(); }
  [[nodiscard]] Parameter<CycleSpin>& spin() noexcept { return meter_.spin(); }
  [[nodiscard]] Parameter<LinkStatistics>& link_statistics() noexcept { return meter_.link_statistics(); }
  [[nodiscard]] Parameter<ResourceStatistics>& resource_statistics() noexcept { return meter_.resource_statistics(); }
  [[nodiscard]] Parameter<LoopStatistics>& loop_statistics() noexcept { return meter_.loop_statistics(); }
  [[nodiscard]] Parameter<HeapUses>& heap_uses() noexcept { return meter_.heap_uses(); }
  /// One for each actuator of the descriptor.
  [[nodiscard]] std::span<const std::unique_ptr<OutputParameter>> outputs() const noexcept { return gate_.outputs(); }

  // --- the cycle --------------------------------------------------------------------------------------------------
  /// One cycle that was due at `planned`, or was started by a sample before that; returns when the next one is due.  Realtime: bounded, no allocation, no lock;
  /// of each device the system calls of a receive and of a send, and of one send more where it falls back or is let go (DataFlow), those of its links, and one for its own
  /// processor time, or two where it has spun before.
  /// `spun_from`: the thread's processor time when it began to spin; empty: it has slept until it was woken.
  TimePoint step(TimePoint planned, std::optional<Duration> spun_from = {}) noexcept;
  /// What may start the next one before it is due.  Realtime: wait-free. Thread: cycle.
  [[nodiscard]] const CycleWait& wait() const noexcept { return pace_.wait(); }

  /// What the author's code did in cycles that have been, the first of it; who has looked empties it.  Thread: the cycle's, between two of them.
  [[nodiscard]] AuthorUses& author_uses() noexcept { return author_uses_; }

  // --- the author, from inside the cycle --------------------------------------------------------------------------
  [[nodiscard]] ReportWriter& reports() noexcept { return reports_; }
  void inhibit(Inhibition reason) noexcept { control_.inhibit(reason); }

 private:
  void begin_counting(const descriptor::Configuration& configuration) noexcept;
  void take_commands(TimePoint planned) noexcept;
  void attach_input(const CycleCommand& command) noexcept;
  void detach_input(const CycleCommand& command) noexcept;
  void detach_output(const CycleCommand& command) noexcept;
  void begin_self_test(const CycleCommand& command) noexcept;
  void run_function(const CycleCommand& command) noexcept;
  void reconfigure(Reconfiguration& wanted, TimePoint planned) noexcept;
  /// Why a state is not to be entered; null: it may be.
  [[nodiscard]] const char* why_not(State state) const noexcept;
  void enter(State state) noexcept;
  void run_node(TimePoint planned) noexcept;
  void run_self_test(Cycle cycle) noexcept;
  void account(const CyclePace::Start& start, TimePoint started) noexcept;

  std::size_t sample(std::uint16_t parameter, int member, MutableOctets big_endian) noexcept override;

  Parts parts_;
  CyclePlan plan_;
  ControlState control_;
  ReportWriter reports_;
  PermitWatch permit_;
  SelfTestRun self_test_;
  DeviceInputs device_inputs_;
  CycleInputs inputs_;
  ActuatorGate gate_;
  BumplessChange bumpless_change_;
  OwnWrites own_writes_;
  CycleMeter meter_;
  CyclePace pace_;
  std::vector<FunctionHandler> functions_;
  std::atomic<const descriptor::Configuration*> in_force_{nullptr};
  bool first_{true};
  std::uint64_t count_{0};
  AuthorUses author_uses_;
};

}  // namespace hirosco
