// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "hirosco/data_transfer/device/own_flow_access.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "supervisor/keeper/kept_store.hpp"
#include "supervisor/platform/launch/flight_launcher.hpp"
#include "supervisor/platform/launch/memory_reach.hpp"
#include "supervisor/platform/launch/programs_in_use.hpp"
#include "supervisor/platform/launch/running_processes.hpp"
#include "supervisor/platform/launch/standard_error.hpp"

namespace hirosco::supervisor {

/// What can be done to it whatever it does, kept beside whoever else holds it. SystemFailure: no descriptor is left.
[[nodiscard]] Result<std::shared_ptr<ProcessGrip>> grip_of(const Process& process);

/// Starts each subsystem as a process of its own that inherits its end of the control channel and its two pages; who is
/// who is proven by the inherited socket (decision 2).  Thread: the supervisor's.
class SystemLauncher final : public FlightLauncher {
 public:
  /// \param own_users Who started the flight may end users of their own (docs/adr/0177): they are what it starts where the mission and our
  /// rights have it so.
  explicit SystemLauncher(bool own_users = false) : own_users_granted_{own_users} {}
  /// Holds to the mission's manifest where it has one. Behind keep_with(): who goes on for another supervisor waits for no disk here.
  [[nodiscard]] std::expected<std::string, std::string> begin(const descriptor::Mission& mission) override;
  [[nodiscard]] Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) override;
  [[nodiscard]] std::expected<AdoptedSubsystem, NotAdopted> adopt(
      const descriptor::MissionSubsystem& subsystem) override;
  [[nodiscard]] bool keep_with(StoreClient store, const descriptor::Mission& mission, InheritedParts inherited,
                               KeeperPage* page) override;
  [[nodiscard]] std::optional<StartRefusal> refuse(const descriptor::MissionSubsystem& subsystem) override {
    return programs_.refuse(subsystem);
  }
  [[nodiscard]] std::expected<bool, StartRefusal> prepare(const descriptor::MissionSubsystem& subsystem,
                                                          const std::string& version) override {
    return programs_.has_manifest() ? programs_.prepare(subsystem, version)
                                    : ProcessLauncher::prepare(subsystem, version);
  }
  void use(const descriptor::MissionSubsystem& subsystem, const std::string& version) override {
    programs_.use(subsystem, version);
  }
  [[nodiscard]] std::string shut_out(std::uint32_t process, const descriptor::MissionSubsystem& flown,
                                     const descriptor::MissionSubsystem& fresh) override;
  [[nodiscard]] std::string let_in(std::uint32_t process, const descriptor::MissionSubsystem& fresh) override {
    return reach_.let_in(process, fresh, own_group_of(fresh));
  }
  [[nodiscard]] std::string keep_in(std::uint32_t process, const descriptor::MissionSubsystem& now) override {
    return reach_.keep_in(process, now);
  }
  [[nodiscard]] std::string left_open(const descriptor::MissionSubsystem& subsystem) const override;
  void drop(const descriptor::MissionSubsystem& subsystem, const std::string& version) override {
    programs_.drop(subsystem, version);
  }
  /// From now on it starts what the manifest of this mission lists, and nothing else. Reads all of it first.
  const HeldPrograms& hold_to(const descriptor::Mission& mission) { return programs_.hold_to(mission); }
  [[nodiscard]] std::optional<ProcessEnd> ended(std::uint32_t process) override;
  void kill(std::uint32_t process) override { running_.kill(process); }
  [[nodiscard]] std::string_view take_not_kept(std::uint32_t process) override;
  [[nodiscard]] std::vector<std::string> isolation_lacks() const override;
  [[nodiscard]] std::string isolation_not_asked() const override;
  [[nodiscard]] std::optional<ProcessUsage> usage(std::uint32_t process) noexcept override {
    return running_.watch().usage(process);
  }
  [[nodiscard]] std::uint32_t resident_kb(std::uint32_t process) noexcept override {
    return running_.resident_kb(process);
  }
  [[nodiscard]] std::optional<StrayThread> stray(std::uint32_t process, const ThreadPlaces& places) noexcept override {
    return running_.watch().stray(process, places);
  }
  void kill_all() override { running_.kill_all(); }
  [[nodiscard]] bool any_running() override { return running_.any(); }
  [[nodiscard]] int wait_descriptor(std::uint32_t process) override;

 private:
  /// It has started, or goes on. An error leaves `process` to who called.
  [[nodiscard]] Result<LaunchedSubsystem> hold(Process& process, FileDescriptor channel, Mapping vital, Mapping permit);
  /// The same.
  [[nodiscard]] Result<AdoptedSubsystem> take_over(const std::string& name, Process& process,
                                                   std::array<FileDescriptor, kept_roles>& kept);
  [[nodiscard]] NotAdopted end_at_once(std::size_t slot, Process process, const Error& why);
  void keep(const std::string& name, LaunchedSubsystem& launched, const MemoryHandle& vital, const MemoryHandle& permit,
            const FileDescriptor& errors);

  [[nodiscard]] ProcessUser user_of_processes() const noexcept {
    return users_ && one_user_.empty() ? ProcessUser::ItsOwn : ProcessUser::WhoeverFlies;
  }

  /// Empty: it is of whoever flies, or the mission has no user for it.
  [[nodiscard]] std::optional<OwnGroup> own_group_of(const descriptor::MissionSubsystem& subsystem) const;

  bool own_users_granted_;
  std::optional<descriptor::UserNumbers> users_{};  ///< that the mission asks for
  std::map<std::string, std::uint32_t, std::less<>>
      user_of_;  ///< by name, whatever a mission says that is read in flight
  std::string one_user_{};  ///< why they are not given, in words; empty: they are, or none are asked for
  const std::string instance_{flight_instance()};  ///< part of where the frames of devices are
  MemoryReach reach_{instance_};
  SealedMemory memory_;
  StandardError errors_;
  RunningProcesses running_;
  std::map<std::string, Mapping, std::less<>> vital_;  ///< newest page of each subsystem, outlives its process
  ProgramsInUse programs_;
  StoreClient store_{-1};
  std::map<std::string, std::size_t, std::less<>> slots_;
  InheritedParts inherited_;
  KeeperPage* page_{nullptr};
  std::map<std::uint32_t, std::size_t> kept_;  ///< slot of each process
};

}  // namespace hirosco::supervisor
