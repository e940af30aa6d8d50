// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/subsystem/author/module.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "simulation/devices/simulated_device.hpp"
#include "simulation/spacecraft/simulated_ground.hpp"
#include "supervisor/keeper/inhibit_bridge.hpp"
#include "supervisor/keeper/kept_endnodes.hpp"
#include "supervisor/platform/launch/launcher.hpp"
#include "supervisor/supervisor.hpp"

/// The whole spacecraft in one process on virtual time: the same supervisor and subsystem objects as in the executables,
/// deterministic from one seed (architecture, rule 3; mission row B1). No clock, socket or random call while it runs.
namespace hirosco::simulation {

/// Makes the author's object of an executable of the mission: as its module tells, or as a callable does that takes nothing.
struct SubsystemMaker {
  static constexpr const char* no_ground_link =
      "it cannot hold a simulated ground link: its module has no maker on a transport that is given "
      "(subsystem_module<make, make_on_transport>)";

  SubsystemMaker() = default;
  SubsystemMaker(const SubsystemModule& module) : make{module.make}, make_on_transport{module.make_on_transport} {}
  template <std::invocable Make>
  SubsystemMaker(Make maker) : make{std::move(maker)} {}

  std::function<std::unique_ptr<Subsystem>()> make;
  /// Of what can hold the mission's ground link: here it is made on the simulated ground.
  std::function<std::unique_ptr<Subsystem>(OpenGroundTransport)> make_on_transport;
};
using SubsystemCatalogue = std::map<std::string, SubsystemMaker, std::less<>>;
/// Makes the simulated device of an executable, at the device's side of an endnode.
using MakeDevice =
    std::function<std::unique_ptr<SimulatedDevice>(FlowFactory&, const FlowAddress&, const SimulatedDevice::Settings&)>;
using DeviceCatalogue = std::map<std::string, MakeDevice, std::less<>>;

/// How a telecommand of the simulated ground ended.
struct CommandOutcome {
  bool accepted{false};
  bool started{false};
  int progress_reports{0};
  bool completed{false};
  std::optional<pus::FailureCode> failure;
  std::uint8_t failure_subtype{0};
};

class Spacecraft final : private supervisor::ProcessLauncher {
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
    /// What stands between the supervisor and a member's channel, for faults of that; empty: nothing.
    std::function<std::unique_ptr<Channel>(std::string_view member, std::unique_ptr<Channel>)> wrap_channel{};
    /// Of persistent parameters, from earlier flights and for later ones; null: of this flight alone.
    supervisor::ValueStore* values{nullptr};
    /// What is read again of descriptors.
    descriptor::FileSource files{descriptor::file_system()};
    /// Where the supervisor dies, another one goes on (docs/adr/0093), after so long; empty: its death ends the flight.
    std::optional<Duration> revives_after{};
    std::size_t journal_octets{std::size_t{256} << 10};  ///< two copies of what one knows have room in it
  };
  explicit Spacecraft(const Parts& parts);
  ~Spacecraft() override;

  /// Runs for a span of virtual time, or until the supervisor has finished.
  void run(Duration span);
  /// Runs until the condition holds, at most for `limit`; false when it never did.
  bool run_until(const std::function<bool()>& condition, Duration limit);
  [[nodiscard]] TimePoint now() const noexcept { return clock_.now(); }

  [[nodiscard]] supervisor::Supervisor& supervisor() noexcept { return *supervisor_; }
  [[nodiscard]] supervisor::Guard& guard() noexcept { return *guard_; }
  [[nodiscard]] SimulatedGround& ground() noexcept { return ground_; }
  [[nodiscard]] SimulatedDevice* device(std::string_view name) noexcept;
  [[nodiscard]] const GenericSubsystem* subsystem(std::string_view name) const noexcept;
  [[nodiscard]] const VitalPage* vital(std::string_view name) const noexcept;
  [[nodiscard]] PermitPage* permit(std::string_view name) noexcept;
  /// The process ends without a word, as by kill -9.
  void kill(std::string_view name);
  /// The supervisor ends without a word, as by kill -9, between two of its steps.
  void kill_supervisor();
  /// Nobody goes on for it.
  void keep_down() noexcept { revive_at_.reset(); }
  /// Supervisors that have died.
  [[nodiscard]] int supervisor_deaths() const noexcept { return supervisor_deaths_; }
  /// It ends at this very moment, in the middle of its step: of what it does from here on until that returns nothing reaches pages
  /// or the journal; whoever stands between it and its channels (`wrap_channel`) keeps back what it sends.
  void supervisor_dies_here();
  [[nodiscard]] bool supervisor_is_dying() const noexcept { return last_moment_ != nullptr; }
  /// `hirosco safe`: the guard stops everything at once, or the next one where there is none now; the supervisor hears of it in its next
  /// step.
  void stop_beside_flight();
  /// The process stands still, as by SIGSTOP, and goes on; the supervisor by its own name.
  void stop(std::string_view name, bool stopped);
  /// Its next cycle never ends: with one processor for all cycles (adr 0007) nobody else's runs, until it is killed.
  void spin(std::string_view name);
  /// A spin that no cycle has begun yet will not be; one that has ends with its process only.
  void call_spin_off(std::string_view name);
  /// Its service loop stands still and goes on, beside its cycle.
  void stick(std::string_view name, bool stuck);
  /// Puts a packet into a subsystem's end of its channel as if it had sent it. False: it is gone, or the channel is full.
  bool send_as(std::string_view name, Octets packet);
  /// Whether its process is there.
  [[nodiscard]] bool alive(std::string_view name) const noexcept { return find(name) != nullptr; }
  /// The next cycles of a subsystem take that long; otherwise a cycle takes no time.
  void strain(std::string_view name, int cycles, Duration takes);
  /// Called after every cycle of the fastest subsystem, for traces and checks at cycle rate.
  void on_cycle(std::function<void(std::string_view subsystem, TimePoint)> watch) { watch_ = std::move(watch); }

  /// Sends a request by its name from ground with all acknowledgements and runs until it has ended, at most for `limit`. Arguments
  /// stand in declared order, arrays element by element.
  CommandOutcome command(std::string_view subsystem, std::string_view function, const std::vector<Value>& arguments,
                         Duration limit = 10s);

 private:
  struct Member;
  class Grip;
  // ProcessLauncher
  Result<supervisor::LaunchedSubsystem> launch(const descriptor::MissionSubsystem& described) override;
  std::expected<supervisor::AdoptedSubsystem, supervisor::NotAdopted> adopt(
      const descriptor::MissionSubsystem& described) override;
  std::optional<supervisor::ProcessEnd> ended(std::uint32_t process) override;
  void kill(std::uint32_t process) override;

  void make_supervisor(std::uint32_t first_epoch);
  void revive_supervisor();
  void step_supervisor();
  [[nodiscard]] std::unique_ptr<Channel> supervisor_end(Member& member);
  bool advance(TimePoint end);
  [[nodiscard]] bool may_cycle(const Member& member) const noexcept;
  void step_device(std::size_t device);
  void step_cycle(Member& member);
  void wake_who_waits();
  void step_service(Member& member);
  [[nodiscard]] Member* find(std::string_view name) noexcept;
  [[nodiscard]] const Member* find(std::string_view name) const noexcept;

  Parts parts_;
  ManualClock clock_;
  HeapMemory memory_;
  LocalFlows flows_;
  SimulatedGround ground_;
  std::unique_ptr<supervisor::PacketLog> log_;
  std::vector<std::unique_ptr<Member>> members_;
  struct Device {
    const descriptor::SimulatedDevice* described;
    std::unique_ptr<SimulatedDevice> device;
  };
  std::vector<Device> devices_;
  supervisor::MemoryValueDisk forgotten_;
  supervisor::DirectValueStore own_values_{forgotten_, "values"};
  supervisor::DirectReadings readings_{parts_.files};
  std::unique_ptr<supervisor::LogReadings> log_readings_;  ///< null: its log is not read
  // What the keeper holds.
  std::unique_ptr<supervisor::KeeperPage> kept_{std::make_unique<supervisor::KeeperPage>()};
  std::optional<supervisor::AskedStops> stops_;  ///< of the newest supervisor
  std::vector<std::byte> journal_memory_;
  std::optional<supervisor::Journal> journal_;
  std::optional<supervisor::InhibitBridge> bridge_;
  std::optional<TimePoint> revive_at_;  ///< there is no supervisor now
  std::uint32_t next_first_epoch_{1};
  struct LastMoment;
  std::unique_ptr<LastMoment> last_moment_;  ///< of a supervisor that dies in the middle of its step; null: none does
  int supervisor_deaths_{0};
  bool supervisor_dies_{false};
  std::optional<supervisor::Guard> guard_;
  std::unique_ptr<supervisor::Supervisor> supervisor_;
  TimePoint supervisor_wake_{};
  TimePoint guard_wake_{};
  std::function<void(std::string_view, TimePoint)> watch_;
  std::uint16_t sequence_{0};  ///< of the ground's telecommands
};

}  // namespace hirosco::simulation
