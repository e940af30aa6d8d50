// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
#include "hirosco/subsystem/cycle/budget_watch.hpp"
#include "hirosco/subsystem/cycle/cycle_pace.hpp"
#include "hirosco/subsystem/cycle/device_slot.hpp"
#include "hirosco/subsystem/cycle/link_slots.hpp"
#include "hirosco/subsystem/cycle/loop_meter.hpp"
#include "hirosco/subsystem/cycle/loop_rings.hpp"
#include "hirosco/subsystem/cycle/overrun_watch.hpp"
#include "hirosco/subsystem/cycle/realtime_watch.hpp"
#include "hirosco/subsystem/cycle/reconfiguration.hpp"
#include "hirosco/subsystem/cycle/resource_meter.hpp"
#include "hirosco/subsystem/cycle/self_test_run.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

/// The cycle of a subsystem (architecture, rule 1): reads links and devices, runs the state's node, gates the actuators,
/// samples housekeeping, writes links and devices.
namespace hirosco {

/// Cycle statistics as a parameter of every subsystem: CYCLE_STATS (descriptor/model/framework_parameters.hpp).
struct CycleStatistics {
  std::uint32_t overruns{0};
  float max_us{0.0F};  ///< longest execution since the configuration was applied
  float avg_us{0.0F};  ///< mean over about the last 1,000 cycles
};

/// Where the cycles of a configuration fell, as a parameter of every subsystem: CYCLE_TIMES. Bin 0: below 1 us; bin i:
/// from 2^(i-1) us to below 2^i us; the last one: all above.
struct CycleTimes {
  std::array<std::uint32_t, 16> execution{};  ///< of the cycle's own work
  std::array<std::uint32_t, 16> latency{};  ///< from the planned instant to the start
};

/// What the real-time links brought since they were made, as a parameter of every subsystem: LINK_STATS.
struct LinkStatistics {
  std::uint32_t received{0};
  std::uint32_t lost{0};  ///< samples that came and went between two cycles: gaps of the count
};

/// A function's handler and what the cycle needs to know of it.
struct BoundFunction {
  FunctionHandler handler;
};

/// What of a configuration the cycle works on. Built by the service loop while the cycle rests.
struct CyclePlan {
  const descriptor::Configuration* configuration{nullptr};
  std::vector<LinkInputSlot> inputs;
  std::vector<LinkOutputSlot> outputs;
  std::vector<DeviceSlot> devices;
  pus::HousekeepingSampler* sampler{nullptr};
  std::vector<std::uint16_t> device_lost_events;  ///< ids, per device
  std::vector<std::uint16_t> fell_back_events;  ///< ids, per device
  std::vector<std::uint16_t> input_stale_events;  ///< per input
};

class CycleLoop final : private pus::SampleSource, private pus::SampleSink {
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
  /// The configuration that the next cycle works by, after prepare().  Realtime: wait-free. Thread: any.
  [[nodiscard]] const descriptor::Configuration& in_force() const noexcept {
    return *in_force_.load(std::memory_order_acquire);
  }
  /// Whether a device of the configuration has not answered since it was opened, and is not late yet.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool awaits_first_answer() const noexcept {
    return awaits_first_answer_.load(std::memory_order_acquire);
  }
  /// The first device that was lost before anybody had heard of it, and why.
  struct NeverAnswered {
    std::uint16_t device{0};
    descriptor::DeviceLoss reason{};
  };
  /// Since the configuration was applied.  Realtime: wait-free. Thread: any.
  [[nodiscard]] std::optional<NeverAnswered> never_answered() const noexcept;
  [[nodiscard]] std::vector<BoundFunction>& functions() noexcept { return functions_; }
  /// Whether the author's self test has passed in this configuration, and nothing has voided it.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool self_test_passed() const noexcept { return self_test_.passed(); }
  [[nodiscard]] Parameter<CycleStatistics>& statistics() noexcept { return statistics_; }
  [[nodiscard]] Parameter<CycleTimes>& times() noexcept { return times_parameter_; }
  [[nodiscard]] Parameter<CycleBudget>& budget() noexcept { return budget_parameter_; }
  [[nodiscard]] Parameter<CycleSpin>& spin() noexcept { return spin_parameter_; }
  /// One for each actuator of the descriptor.
  [[nodiscard]] std::span<const std::unique_ptr<OutputParameter>> outputs() const noexcept { return outputs_; }
  [[nodiscard]] Parameter<LinkStatistics>& link_statistics() noexcept { return link_statistics_; }
  [[nodiscard]] Parameter<ResourceStatistics>& resource_statistics() noexcept { return resource_statistics_; }
  [[nodiscard]] Parameter<LoopStatistics>& loop_statistics() noexcept { return loop_statistics_; }
  [[nodiscard]] Parameter<HeapUses>& heap_uses() noexcept { return heap_uses_; }
  /// What the service loop has used of the heap, for HEAP_USES.  Realtime: wait-free. Thread: any.
  void note_service_heap(std::uint64_t uses) noexcept { service_heap_.store(uses, std::memory_order_relaxed); }

  /// Whether the author's node wrote this parameter in the newest cycle: what anybody else writes would not last.
  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] bool writes_itself(std::size_t parameter) const noexcept {
    return parameter < own_writes_octets_ && own_writes_[parameter].load(std::memory_order_relaxed) != 0;
  }

  /// Another permit page, of a supervisor that goes on for one that died (docs/adr/0093): the next cycle looks at it. What the
  /// page before permitted holds on only where this one permits it, under the same epoch. Thread: service.
  void offer_permit(const PermitPage& page) noexcept { offered_permit_.store(&page, std::memory_order_release); }
  /// Whether the cycle looks at what was offered: what it looked at before may be given back.  Realtime: wait-free. Thread: service.
  [[nodiscard]] bool looks_at_offered_permit() const noexcept {
    return permit_.load(std::memory_order_acquire) == offered_permit_.load(std::memory_order_relaxed);
  }
  /// Takes what was offered. Thread: the cycle's, or the service loop's while the cycle rests.  Realtime: wait-free.
  void take_permit() noexcept;

  // --- the cycle --------------------------------------------------------------------------------------------------
  /// One cycle that was due at `planned`, or was started by a sample before that; returns when the next one is due.  Realtime: bounded, no allocation, no lock,
  /// at most one system call per device, and one for its own processor time, or two where it has spun before.
  /// `spun_from`: the thread's processor time when it began to spin; empty: it has slept until it was woken.
  TimePoint step(TimePoint planned, std::optional<Duration> spun_from = {}) noexcept;
  /// What may start the next one before it is due.  Realtime: wait-free. Thread: cycle.
  [[nodiscard]] const CycleWait& wait() const noexcept { return pace_.wait(); }

  // --- the author, from inside the cycle --------------------------------------------------------------------------
  void raise(std::uint16_t event, std::span<const double> arguments) noexcept;
  /// The same with its auxiliary data; nothing when these have not the length of the descriptor's.
  void raise_encoded(std::uint16_t event, Octets auxiliary) noexcept;
  void inhibit(Inhibition reason) noexcept { inhibited_ |= reason; }
  void report(ReportKind kind, std::uint16_t index, const pus::Request& request, AttachedLink* link = nullptr) noexcept;

  void fail_call(ReportKind kind, pus::FailureCode code, const pus::Request& request, const Error& why) noexcept;

 private:
  void raise_found(const descriptor::Event& event, Octets auxiliary) noexcept;
  void answer(CycleReport head, Octets payload = {}) noexcept;
  void take_commands(TimePoint planned) noexcept;
  // reconfiguration.cpp
  void begin_counting(const descriptor::Configuration& configuration) noexcept;
  [[nodiscard]] const char* why_not(const Reconfiguration& wanted) const noexcept;
  void reconfigure(Reconfiguration& wanted, TimePoint planned) noexcept;
  void end_reconfiguration() noexcept;
  void run_function(const CycleCommand& command) noexcept;
  /// Why a state is not to be entered; null: it may be.
  [[nodiscard]] const char* why_not(State state) const noexcept;
  void enter(State state) noexcept;
  // actuator_gate.cpp
  void check_permit() noexcept;
  void listen_to_supervisor(bool counts) noexcept;
  void write_outputs(TimePoint planned) noexcept;
  void write_devices() noexcept;
  [[nodiscard]] LinkStatus link_status() const noexcept;
  // lost_inputs.cpp
  void read_inputs(TimePoint started, bool counts) noexcept;
  [[nodiscard]] bool controlling() const noexcept;
  // cycle.cpp
  void run_node(TimePoint planned) noexcept;
  void run_self_test(Cycle cycle) noexcept;
  void end_self_test(const std::optional<SelfTestRun::End>& end) noexcept;
  void note_stores() noexcept;
  void note_own_writes() noexcept;
  void account(const CyclePace::Start& start, TimePoint started) noexcept;
  [[nodiscard]] const LinkInputSlot* starter() const noexcept;
  void count_links() noexcept;
  void hold_to_budget() noexcept;
  void hold_to_realtime(const RealtimeUses& of_cycle) noexcept;

  std::size_t sample(std::uint16_t parameter, int member, MutableOctets big_endian) noexcept override;
  MutableOctets reserve(std::size_t octets) noexcept override;
  void commit(std::uint16_t structure, std::size_t octets) noexcept override;

  [[nodiscard]] const PermitPage& permit() const noexcept { return *permit_.load(std::memory_order_relaxed); }

  Parts parts_;
  std::atomic<const PermitPage*> permit_;  ///< that the cycle looks at
  std::atomic<const PermitPage*> offered_permit_;
  CyclePlan plan_;
  std::atomic<const descriptor::Configuration*> in_force_{nullptr};
  const Reconfiguration* taken_over_{nullptr};  ///< in this cycle
  SelfTestRun self_test_;
  std::vector<BoundFunction> functions_;
  Parameter<CycleStatistics> statistics_;
  Parameter<CycleTimes> times_parameter_;
  Parameter<CycleBudget> budget_parameter_;
  Parameter<CycleSpin> spin_parameter_;
  Parameter<LinkStatistics> link_statistics_;
  Parameter<ResourceStatistics> resource_statistics_;
  Parameter<LoopStatistics> loop_statistics_;
  Parameter<HeapUses> heap_uses_;
  std::atomic<std::uint64_t> service_heap_{0};
  std::vector<std::unique_ptr<OutputParameter>> outputs_;
  std::vector<std::byte> event_buffer_;  ///< room for the largest event of the descriptor
  struct Watched {
    const ParameterCell* cell;
    std::uint64_t stores;  ///< before the node ran
    std::uint16_t parameter;
  };
  std::vector<Watched> watched_;  ///< what ST[20] might set
  std::unique_ptr<std::atomic<std::uint8_t>[]> own_writes_;  ///< by parameter
  std::size_t own_writes_octets_{0};
  std::uint32_t report_number_{0};
  MutableOctets reserved_;  ///< housekeeping report under assembly

  State state_{State::PreOperational};
  CyclePace pace_;
  std::optional<std::size_t> starter_;  ///< of the inputs: whose samples start the cycle
  bool first_{true};
  std::uint32_t inhibited_{0};
  std::atomic<bool> awaits_first_answer_{false};
  std::atomic<std::uint32_t> never_answered_{0};  ///< device + 1, reason above it; 0: none
  bool awaits_device_{false};  ///< what a device said last is of before
  std::uint64_t count_{0};
  std::uint32_t entered_epoch_{0};
  std::uint32_t permitted_epoch_{0};  ///< of the permit page, as checked in this cycle
  std::uint64_t heartbeat_{0};  ///< of the supervisor, as seen in the last cycle
  std::uint32_t silent_cycles_{0};  ///< of the supervisor
  std::uint32_t silence_limit_{1};
  std::uint32_t latency_max_ns_{0};
  std::uint32_t execution_max_ns_{0};
  double execution_mean_ns_{0.0};
  CycleTimes times_{};
  BudgetWatch budget_;
  OverrunWatch overruns_;
  RealtimeWatch realtime_;
  std::vector<char> input_was_stale_;
};

}  // namespace hirosco
