// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/simulated_processes.hpp"

#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>

namespace hirosco::simulation {
namespace {

/// The supervisor's end of a simulated channel: closing it ends the subsystem, as the end of a process would.
class ChannelEnd final : public Channel {
 public:
  /// `kept`: by the keeper, while the supervisor dies.
  ChannelEnd(ChannelPair& pair, const bool& kept) : pair_{pair}, kept_{kept} {}
  ~ChannelEnd() override {
    if (!kept_) pair_.close_supervisor_end();
  }
  Result<> send(const Message& message) override { return pair_.supervisor_end().send(message); }
  Result<Found> receive(MessageBuffer& buffer) override { return pair_.supervisor_end().receive(buffer); }

 private:
  ChannelPair& pair_;
  const bool& kept_;
};

/// What the guard holds of a simulated process.
class SimulatedGrip final : public supervisor::ProcessGrip {
 public:
  SimulatedGrip(SimulatedProcess& process, const Clock& clock) : process_{process}, clock_{clock} {}
  void take_realtime() noexcept override { process_.take_realtime(true); }
  // Service loops of simulated processes take no time, so they keep none from others.
  void take_loops_realtime() noexcept override {}
  void give_realtime() noexcept override { process_.take_realtime(false); }
  supervisor::LoopTime loop_time() noexcept override { return {}; }
  Duration processor_time() noexcept override { return process_.processor_time(clock_.now()); }
  void kill() noexcept override { process_.kill(); }

 private:
  SimulatedProcess& process_;
  const Clock& clock_;
};

[[nodiscard]] std::string listed_as(const descriptor::MissionSubsystem& described, const std::string& version) {
  return version.empty() ? described.executable : described.executable + "@" + version;
}

}  // namespace

SimulatedProcess* SimulatedProcesses::find(std::string_view name) noexcept {
  const auto found = std::ranges::find_if(
      processes_, [&](const auto& process) { return process->name() == name && process->lives(); });
  return found != processes_.end() ? found->get() : nullptr;
}
const SimulatedProcess* SimulatedProcesses::find(std::string_view name) const noexcept {
  return const_cast<SimulatedProcesses*>(this)->find(name);
}

void SimulatedProcesses::kill(std::string_view name) {
  for (const auto& process : processes_)
    if (process->name() == name) process->kill();
}

Result<supervisor::LaunchedSubsystem> SimulatedProcesses::launch(const descriptor::MissionSubsystem& described) {
  const std::string version = version_of(described);
  const auto maker = parts_.subsystems.find(listed_as(described, version));
  if (maker == parts_.subsystems.end() || !maker->second.make)
    return fail(ErrorCode::NotFound, "no such subsystem in this program");
  const bool holds_ground_link = described.subsystem.name == parts_.mission.ground.subsystem;
  if (holds_ground_link && !maker->second.make_on_transport)
    return fail(ErrorCode::InvalidArgument, SubsystemMaker::no_ground_link);
  auto author = holds_ground_link ? maker->second.make_on_transport(parts_.ground.transport()) : maker->second.make();
  const SimulatedProcess* before = nullptr;
  for (const auto& earlier : processes_)
    if (earlier->id() == described.subsystem.id) before = earlier.get();
  processes_.push_back(std::make_unique<SimulatedProcess>(described, version, std::move(author), parts_.platform));
  SimulatedProcess& process = *processes_.back();
  if (before != nullptr) process.count_on_from(*before);
  supervisor::LaunchedSubsystem launched;
  launched.vital = process.vital_memory();
  launched.permit = process.permit_memory();
  launched.port =
      std::make_unique<supervisor::LocalMemberPort>(supervisor_end(process), launched.vital, launched.permit);
  launched.process = static_cast<std::uint32_t>(processes_.size());
  launched.grip = std::make_shared<SimulatedGrip>(process, parts_.platform.clock);
  return launched;
}

std::expected<supervisor::AdoptedSubsystem, supervisor::NotAdopted> SimulatedProcesses::adopt(
    const descriptor::MissionSubsystem& described) {
  const auto found = std::ranges::find_if(
      processes_, [&](const auto& process) { return process->id() == described.subsystem.id && process->lives(); });
  if (found == processes_.end()) return std::unexpected{supervisor::NotAdopted{}};
  SimulatedProcess& process = **found;
  const PermitPage& before = process.newest_permit();
  supervisor::AdoptedSubsystem adopted;
  adopted.epoch = before.epoch.load();
  adopted.permitted = before.permits(adopted.epoch);
  adopted.stopped = before.stop.load() != 0;
  adopted.powered = before.powered.load();
  auto handle = parts_.platform.memory.create("permit", sizeof(PermitPage));
  auto page = parts_.platform.memory.map(*handle, Access::ReadWrite);
  auto& fresh = *::new (page->octets.data()) PermitPage;
  fresh.epoch = adopted.epoch;
  fresh.stop = adopted.stopped ? 1 : 0;
  fresh.powered = adopted.powered;
  fresh.newest_stop = before.newest_stop.load();
  static_cast<void>(parts_.platform.memory.seal_writers(*handle));
  process.keep_permit(*page);
  adopted.permit = std::move(*handle);
  adopted.launched.vital = process.vital_memory();
  adopted.launched.permit = std::move(*page);
  adopted.launched.port = std::make_unique<supervisor::LocalMemberPort>(supervisor_end(process), adopted.launched.vital,
                                                                        adopted.launched.permit);
  adopted.launched.process = static_cast<std::uint32_t>(found - processes_.begin() + 1);
  adopted.launched.grip = std::make_shared<SimulatedGrip>(process, parts_.platform.clock);
  return adopted;
}

std::expected<bool, supervisor::StartRefusal> SimulatedProcesses::prepare(const descriptor::MissionSubsystem& described,
                                                                          const std::string& version) {
  const std::string name = listed_as(described, version);
  if (parts_.subsystems.contains(name)) return true;
  return std::unexpected{supervisor::StartRefusal{{ErrorCode::NotFound, "no such version in this program"},
                                                  name + " is no subsystem of this program"}};
}

void SimulatedProcesses::use(const descriptor::MissionSubsystem& described, const std::string& version) {
  versions_[described.subsystem.id] = parts_.mistake_version ? parts_.mistake_version(version) : version;
}

std::string SimulatedProcesses::version_of(const descriptor::MissionSubsystem& described) const {
  const auto found = versions_.find(described.subsystem.id);
  return found != versions_.end() ? found->second : std::string{};
}

std::optional<supervisor::ProcessEnd> SimulatedProcesses::ended(std::uint32_t process) {
  return processes_[process - 1]->end();
}

void SimulatedProcesses::kill(std::uint32_t process) { processes_[process - 1]->kill(); }

std::unique_ptr<Channel> SimulatedProcesses::supervisor_end(SimulatedProcess& process) {
  std::unique_ptr<Channel> channel = std::make_unique<ChannelEnd>(process.channels(), channels_kept_);
  return parts_.wrap_channel ? parts_.wrap_channel(process.name(), std::move(channel)) : std::move(channel);
}

}  // namespace hirosco::simulation
