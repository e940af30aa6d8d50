// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "supervisor/platform/launch/launcher.hpp"

namespace hirosco::simulation {

/// The craft's time as a subsystem reads it: in a cycle that takes long, all readings but the first are later by that.
class ProcessClock final : public Clock {
 public:
  explicit ProcessClock(const Clock& craft) : craft_{craft} {}
  void begin(Duration takes) noexcept {
    takes_ = takes;
    read_ = false;
  }
  void end() noexcept { takes_ = Duration{0}; }

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override { return craft_.now() + passed(); }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return craft_.onboard() + passed(); }
  [[nodiscard]] Duration passed() const noexcept { return std::exchange(read_, true) ? takes_ : Duration{0}; }

  const Clock& craft_;
  Duration takes_{0};
  mutable bool read_{false};
};

/// One subsystem as an object: what its process would hold, when its loops are due, and what can happen to it as to a process. It stays
/// when it has ended, as what others hold of its pages and its channel would.
class SimulatedProcess {
 public:
  static constexpr TimePoint never = TimePoint::max();

  /// `version`: of its program; empty: the mission's own.
  SimulatedProcess(const descriptor::MissionSubsystem& described, std::string version,
                   std::unique_ptr<Subsystem> author, Platform platform);
  SimulatedProcess(const SimulatedProcess&) = delete;
  SimulatedProcess& operator=(const SimulatedProcess&) = delete;

  [[nodiscard]] const std::string& name() const noexcept { return described_.subsystem.name; }
  [[nodiscard]] std::uint16_t id() const noexcept { return described_.subsystem.id; }
  [[nodiscard]] const std::string& version() const noexcept { return version_; }
  [[nodiscard]] bool lives() const noexcept { return !end_; }
  /// Empty while it lives.
  [[nodiscard]] const std::optional<supervisor::ProcessEnd>& end() const noexcept { return end_; }
  /// Null: it has ended.
  [[nodiscard]] const GenericSubsystem* subsystem() const noexcept { return engine_ ? &*engine_ : nullptr; }

  // --- what it shares with the supervisor -----------------------------------------------------------------------------
  [[nodiscard]] const VitalPage& vital() const noexcept { return *vital_; }
  /// Counts outlive the process (decision 8b).
  void count_on_from(const SimulatedProcess& before) noexcept { vital_->counters = before.vital_->counters; }
  [[nodiscard]] Mapping vital_memory() const;
  /// Of the supervisor that started it.
  [[nodiscard]] Mapping permit_memory() const;
  /// Of the newest supervisor.
  [[nodiscard]] PermitPage& newest_permit() noexcept {
    return permits_.empty() ? *permit_ : *reinterpret_cast<PermitPage*>(permits_.back().octets.data());
  }
  /// Another supervisor goes on with it and writes this page; the ones before stay for who may still look at them.
  void keep_permit(const Mapping& page) { permits_.push_back(page); }
  [[nodiscard]] ChannelPair& channels() noexcept { return channels_; }

  // --- its loops ------------------------------------------------------------------------------------------------------
  /// When each is due; `never` where it has ended, or what has happened to it keeps that loop from its steps.
  [[nodiscard]] TimePoint service_due() const noexcept { return runs() && !stuck_ ? service_wake_ : never; }
  [[nodiscard]] TimePoint cycle_due() const noexcept { return runs() && !spinning_ ? cycle_wake_ : never; }
  [[nodiscard]] TimePoint own_loops_due() const noexcept;
  /// Its cycle never ends and keeps the processor of all cycles as long as it has real-time priority.
  [[nodiscard]] bool keeps_processor() const noexcept { return runs() && spinning_ && cycling_ && !realtime_taken_; }
  /// One step of the service loop.
  void step_service(TimePoint now);
  /// One cycle. False: none is wanted, and it rests.
  bool step_cycle();
  /// One step of each of its loops of services of its own that is due.
  void step_own_loops(TimePoint now);
  /// The sample for which its cycle waits may have arrived: then it is due at once, or as soon as it may be.
  void wake_cycle(TimePoint now) noexcept;

  // --- what can happen to it ------------------------------------------------------------------------------------------
  /// It ends without a word, as by kill -9.
  void kill();
  /// All of it stands still, as by SIGSTOP, and goes on.
  void stop(bool stopped) noexcept { stopped_ = stopped; }
  /// Its next cycle never ends, until it is killed.
  void spin(TimePoint now) noexcept;
  /// A spin that no cycle has begun yet will not be.
  void call_spin_off() noexcept;
  /// Its service loop stands still and goes on, beside its cycle.
  void stick(bool stuck) noexcept { stuck_ = stuck; }
  /// Its next cycles take that long; otherwise a cycle takes no time.
  void strain(int cycles, Duration takes) noexcept;
  /// Puts a packet into its end of its channel as if it had sent it. False: the channel is full.
  [[nodiscard]] bool send(Octets packet);
  void take_realtime(bool taken) noexcept { realtime_taken_ = taken; }
  /// It has had the processor only while it spins.
  [[nodiscard]] Duration processor_time(TimePoint now) const noexcept {
    return spinning_ ? now - spins_since_ : Duration{0};
  }

 private:
  [[nodiscard]] bool runs() const noexcept { return lives() && !stopped_; }
  [[nodiscard]] TimePoint own_loop_due(std::size_t loop) const noexcept;

  descriptor::MissionSubsystem described_;  ///< outlives the supervisor that started it
  std::string version_;
  std::unique_ptr<Subsystem> author_;
  ProcessClock clock_;
  ChannelPair channels_;
  std::shared_ptr<VitalPage> vital_;
  std::shared_ptr<PermitPage> permit_;
  std::vector<Mapping> permits_;  ///< of supervisors that went on
  std::optional<GenericSubsystem> engine_;  ///< there while it lives
  TimePoint service_wake_;
  TimePoint cycle_wake_{never};
  std::vector<TimePoint> loop_wakes_;  ///< of its loops of services of its own
  bool cycling_{false};
  bool stopped_{false};
  bool spinning_{false};
  bool stuck_{false};
  TimePoint spins_since_{};
  bool realtime_taken_{false};
  int strained_cycles_{0};
  Duration cycle_takes_{0};
  std::optional<supervisor::ProcessEnd> end_;
};

}  // namespace hirosco::simulation
