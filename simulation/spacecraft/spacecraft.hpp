// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "simulation/spacecraft/named_commands.hpp"
#include "simulation/spacecraft/simulated_loops.hpp"
#include "simulation/spacecraft/simulated_supervisor.hpp"

/// The whole spacecraft in one process on virtual time: the same supervisor and subsystem objects as in the executables,
/// deterministic from one seed (architecture, rule 3; docs/paper_map.md, B1). No clock, socket or random call while it runs.
namespace hirosco::simulation {

/// Puts the parts together, and moves time from one thing that is due to the next. What others reach into it for goes to the part that it
/// is for.  Thread: one, for this and all of its parts.
class Spacecraft final {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    const SubsystemCatalogue& subsystems;
    const DeviceCatalogue& devices;
    supervisor::Database& log;  ///< receives everything that the supervisor logs
    supervisor::Observer& observer;
    std::uint64_t seed{1};
    bool realtime{true};  ///< which set of limits holds
    /// A log of the caller's in place of one that stores at once in `log`, for faults of it.
    std::function<std::unique_ptr<supervisor::PacketLog>(const Clock&)> make_log{};
    /// Who reads that log while it flies (docs/adr/0140); empty: nobody, and nothing of it comes down again.
    std::function<std::unique_ptr<supervisor::LogReadings>(const Clock&)> make_log_readings{};
    supervisor::DatabaseOpener open_database{};  ///< for SET_DATABASE; empty: one in memory
    WrapChannel wrap_channel{};  ///< for faults of channels
    MistakeVersion mistake_version{};  ///< for faults of who starts processes
    LinkMechanisms links{local_link_mechanisms()};  ///< others, for faults of links
    /// Of persistent parameters, from earlier flights and for later ones; null: of this flight alone.
    supervisor::ValueStore* values{nullptr};
    /// What is read again of descriptors.
    descriptor::FileSource files{descriptor::file_system()};
    /// Where the supervisor dies, another one goes on (docs/adr/0093), after so long; empty: its death ends the flight.
    std::optional<Duration> revives_after{};
    std::size_t journal_octets{std::size_t{256} << 10};  ///< two copies of what one knows have room in it
  };
  explicit Spacecraft(const Parts& parts);
  ~Spacecraft();
  Spacecraft(const Spacecraft&) = delete;
  Spacecraft& operator=(const Spacecraft&) = delete;

  // --- virtual time ---------------------------------------------------------------------------------------------------
  /// Runs for a span of virtual time, or until the supervisor has finished.
  void run(Duration span);
  /// Runs until the condition holds, at most for `limit`; false when it never did.
  bool run_until(const std::function<bool()>& condition, Duration limit);
  [[nodiscard]] TimePoint now() const noexcept { return clock_.now(); }
  /// Called after every cycle of the fastest subsystem, for traces and checks at cycle rate.
  void on_cycle(std::function<void(std::string_view subsystem, TimePoint)> watch) { loops_.on_cycle(std::move(watch)); }
  /// Called after every cycle with what it took by `clock`, which must outlive it. The flight is the same.
  void measure_cycles(const Clock& clock, std::function<void(std::string_view subsystem, CycleTaken)> told) {
    loops_.measure_cycles(clock, std::move(told));
  }

  // --- ground and devices ---------------------------------------------------------------------------------------------
  [[nodiscard]] SimulatedGround& ground() noexcept { return ground_; }
  /// Sends a request by its name from ground with all acknowledgements and runs until it has ended, at most for `limit`. Arguments
  /// stand in declared order, arrays element by element.
  CommandOutcome command(std::string_view subsystem, std::string_view function, const std::vector<Value>& arguments,
                         Duration limit = 10s);
  [[nodiscard]] SimulatedDevice* device(std::string_view name) noexcept { return devices_.find(name); }

  // --- the supervisor and its guard -----------------------------------------------------------------------------------
  /// Not to be asked while there is none.
  [[nodiscard]] supervisor::Supervisor& supervisor() noexcept { return supervision_.supervisor(); }
  [[nodiscard]] supervisor::Guard& guard() noexcept { return supervision_.guard(); }
  /// There is a supervisor, and it does not hang.
  [[nodiscard]] bool supervised() const noexcept { return supervision_.supervises(); }
  /// It has ended the flight in order.
  [[nodiscard]] bool finished() const noexcept { return supervision_.finished(); }
  /// The supervisor ends without a word, as by kill -9, between two of its steps.  \param pause Until another one goes on, in place of
  /// `revives_after`.
  void kill_supervisor(std::optional<Duration> pause = {}) { supervision_.kill(pause); }
  /// It makes no step for that long, beside its guard; where another one would go on, the keeper ends it when its patience is over.
  void hang_supervisor(Duration span) { supervision_.hang(span); }
  /// Nobody goes on for it.
  void keep_down() noexcept { supervision_.keep_down(); }
  /// Supervisors that have died.
  [[nodiscard]] int supervisor_deaths() const noexcept { return supervision_.deaths(); }
  /// It ends at this very moment, in the middle of its step: of what it does from here on until that returns nothing reaches pages
  /// or the journal; whoever stands between it and its channels (`wrap_channel`) keeps back what it sends.
  void supervisor_dies_here() { supervision_.die_here(); }
  /// The same, but that it stands still before for `span`, beside its guard, as one that spins in the middle of its step: the world goes on
  /// within this call. For the keeper's patience: it is ended by that.
  void supervisor_hangs_here(Duration span);
  /// Called as each step of the supervisor begins, and behind its end.
  void on_supervisor_step(std::function<void(SimulatedSupervisor::Moment)> watch) {
    supervision_.on_step(std::move(watch));
  }
  [[nodiscard]] bool supervisor_is_dying() const noexcept { return supervision_.is_dying(); }
  /// `hirosco safe`: the guard stops everything at once, or the next one where there is none now; the supervisor hears of it in its next
  /// step.
  void stop_beside_flight() { supervision_.stop_beside_flight(); }

  // --- subsystems by name: where none of it lives, nothing is there, and nothing happens ----------------------------------
  /// Whether its process is there.
  [[nodiscard]] bool alive(std::string_view name) const noexcept { return processes_.find(name) != nullptr; }
  /// Of the program that it runs; empty: the mission's own.
  [[nodiscard]] std::string_view version(std::string_view name) const noexcept;
  [[nodiscard]] const GenericSubsystem* subsystem(std::string_view name) const noexcept;
  [[nodiscard]] const VitalPage* vital(std::string_view name) const noexcept;
  [[nodiscard]] PermitPage* permit(std::string_view name) noexcept;
  /// The process ends without a word, as by kill -9.
  void kill(std::string_view name) { processes_.kill(name); }
  /// The process stands still, as by SIGSTOP, and goes on; the supervisor by its own name.
  void stop(std::string_view name, bool stopped);
  /// Its next cycle never ends: with one processor for all cycles (adr 0007) nobody else's runs, until it is killed.
  void spin(std::string_view name);
  /// A spin that no cycle has begun yet will not be; one that has ends with its process only.
  void call_spin_off(std::string_view name);
  /// Its service loop stands still and goes on, beside its cycle.
  void stick(std::string_view name, bool stuck);
  /// The next cycles of a subsystem take that long; otherwise a cycle takes no time.
  void strain(std::string_view name, int cycles, Duration takes);
  /// Puts a packet into a subsystem's end of its channel as if it had sent it. False: it is gone, or the channel is full.
  bool send_as(std::string_view name, Octets packet);

 private:
  [[nodiscard]] Platform platform(std::function<void(std::string_view)> explain, bool realtime);
  bool advance(TimePoint end);

  const descriptor::Mission& mission_;
  LinkMechanisms links_;
  ManualClock clock_;
  HeapMemory memory_;
  LocalFlows flows_;
  SimulatedGround ground_;
  SupervisorStores stores_;
  SimulatedProcesses processes_;
  SimulatedDevices devices_;
  SimulatedLoops loops_;
  SimulatedKeeper keeper_;
  SimulatedSupervisor supervision_;  ///< goes before what it is made of
  NamedCommands commands_;
};

}  // namespace hirosco::simulation
