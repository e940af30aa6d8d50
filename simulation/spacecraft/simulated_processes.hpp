// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/spacecraft/catalogues.hpp"
#include "simulation/spacecraft/simulated_ground.hpp"
#include "simulation/spacecraft/simulated_process.hpp"

namespace hirosco::simulation {

/// What stands between the supervisor and a member's channel, for faults of that; empty: nothing.
using WrapChannel = std::function<std::unique_ptr<Channel>(std::string_view member, std::unique_ptr<Channel>)>;

/// Which version is started in place of one that is to be, for faults of that; empty: that one.
using MistakeVersion = std::function<std::string(const std::string& version)>;

/// The processes of all subsystems, those that have ended too: started and gone on with for the supervisor, found by name.
class SimulatedProcesses final : public supervisor::ProcessLauncher {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    const SubsystemCatalogue& subsystems;
    SimulatedGround& ground;  ///< of who holds the ground link
    Platform platform;  ///< around each of them
    WrapChannel wrap_channel;
    MistakeVersion mistake_version;
  };
  explicit SimulatedProcesses(Parts parts) : parts_{std::move(parts)} {}
  SimulatedProcesses(const SimulatedProcesses&) = delete;
  SimulatedProcesses& operator=(const SimulatedProcesses&) = delete;

  /// In the order in which they were started.
  [[nodiscard]] const std::vector<std::unique_ptr<SimulatedProcess>>& all() const noexcept { return processes_; }
  /// Null: none of this name lives.
  [[nodiscard]] SimulatedProcess* find(std::string_view name) noexcept;
  [[nodiscard]] const SimulatedProcess* find(std::string_view name) const noexcept;
  /// It ends without a word, as by kill -9.
  void kill(std::string_view name);
  /// While the supervisor dies the keeper has their channels: the end of a supervisor's end closes none.
  void keep_channels(bool kept) noexcept { channels_kept_ = kept; }

 private:
  // ProcessLauncher; a process is named by its place in `processes_`, from 1 on
  Result<supervisor::LaunchedSubsystem> launch(const descriptor::MissionSubsystem& described) override;
  std::expected<supervisor::AdoptedSubsystem, supervisor::NotAdopted> adopt(
      const descriptor::MissionSubsystem& described) override;
  std::expected<bool, supervisor::StartRefusal> prepare(const descriptor::MissionSubsystem& described,
                                                        const std::string& version) override;
  void use(const descriptor::MissionSubsystem& described, const std::string& version) override;
  std::optional<supervisor::ProcessEnd> ended(std::uint32_t process) override;
  void kill(std::uint32_t process) override;

  [[nodiscard]] std::string version_of(const descriptor::MissionSubsystem& described) const;
  [[nodiscard]] std::unique_ptr<Channel> supervisor_end(SimulatedProcess& process);

  Parts parts_;
  bool channels_kept_{false};
  std::map<std::uint16_t, std::string> versions_;  ///< by APID, where it is not the mission's own
  std::vector<std::unique_ptr<SimulatedProcess>> processes_;
};

}  // namespace hirosco::simulation
