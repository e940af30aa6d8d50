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
#include "supervisor/platform/launch/held_programs.hpp"
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
  [[nodiscard]] std::optional<StartRefusal> refuse(const descriptor::MissionSubsystem& subsystem) override;
  [[nodiscard]] std::expected<bool, StartRefusal> prepare(const descriptor::MissionSubsystem& subsystem,
                                                          const std::string& version) override;
  void use(const descriptor::MissionSubsystem& subsystem, const std::string& version) override;
  [[nodiscard]] std::string shut_out(const descriptor::MissionSubsystem& flown,
                                     const descriptor::MissionSubsystem& fresh) override;
  [[nodiscard]] std::string left_open(const descriptor::MissionSubsystem& subsystem) const override;
  void drop(const descriptor::MissionSubsystem& subsystem, const std::string& version) override;
  /// From now on it starts what the manifest of this mission lists, and nothing else. Reads all of it first.
  const HeldPrograms& hold_to(const descriptor::Mission& mission);
  [[nodiscard]] std::optional<ProcessEnd> ended(std::uint32_t process) override;
  void kill(std::uint32_t process) override;
  [[nodiscard]] std::string_view take_not_kept(std::uint32_t process) override;
  [[nodiscard]] std::vector<std::string> isolation_lacks() const override;
  [[nodiscard]] std::string isolation_not_asked() const override;
  [[nodiscard]] std::optional<ProcessUsage> usage(std::uint32_t process) noexcept override;
  [[nodiscard]] std::uint32_t resident_kb(std::uint32_t process) noexcept override;
  void kill_all() override;
  [[nodiscard]] bool any_running() override;
  [[nodiscard]] int wait_descriptor(std::uint32_t process) override;

 private:
  /// It has started, or goes on. An error leaves `process` to who called.
  [[nodiscard]] Result<LaunchedSubsystem> hold(Process& process, FileDescriptor channel, Mapping vital, Mapping permit);
  /// The same.
  [[nodiscard]] Result<AdoptedSubsystem> take_over(const std::string& name, Process& process,
                                                   std::array<FileDescriptor, kept_roles>& kept);
  [[nodiscard]] NotAdopted end_at_once(std::size_t slot, Process process, const Error& why);
  /// 0, or as which process it is still to be seen to its end.
  std::uint32_t end_now(Process process);
  void keep(const std::string& name, LaunchedSubsystem& launched, const MemoryHandle& vital, const MemoryHandle& permit,
            const FileDescriptor& errors);
  [[nodiscard]] std::string file_of(const descriptor::MissionSubsystem& subsystem) const;

  [[nodiscard]] ProcessUser user_of_processes() const noexcept {
    return users_ && one_user_.empty() ? ProcessUser::ItsOwn : ProcessUser::WhoeverFlies;
  }

  bool own_users_granted_;
  std::optional<descriptor::UserNumbers> users_{};  ///< that the mission asks for
  std::map<std::string, std::uint32_t, std::less<>>
      user_of_;  ///< by name, whatever a mission says that is read in flight
  std::string one_user_{};  ///< why they are not given, in words; empty: they are, or none are asked for
  const std::string instance_{flight_instance()};  ///< part of where the frames of devices are
  SealedMemory memory_;
  StandardError errors_;
  std::map<std::uint32_t, FileDescriptor> memory_use_;  ///< statm of each process, and our own
  std::map<std::uint32_t, ProcessMeter> meters_;
  std::map<std::uint32_t, Process> processes_;
  std::map<std::string, Mapping, std::less<>> vital_;  ///< newest page of each subsystem, outlives its process
  std::unique_ptr<HeldPrograms> held_;  ///< null: the mission has no manifest
  std::map<std::string, std::string, std::less<>> versions_;  ///< by subsystem, where it is not the mission's own
  /// Without one: where each executable was found, and what it is: a disk is not asked again in flight, where it might hang.
  struct FoundProgram {
    std::filesystem::path file;  ///< empty: not looked for yet, or to be looked for again
    bool script{false};
  };
  std::map<std::string, FoundProgram, std::less<>> programs_;
  StoreClient store_{-1};
  std::map<std::string, std::size_t, std::less<>> slots_;
  InheritedParts inherited_;
  KeeperPage* page_{nullptr};
  std::map<std::uint32_t, TimePoint> end_asked_;  ///< of processes that have ended, and nobody has said how
  std::map<std::uint32_t, std::size_t> kept_;  ///< slot of each process
  std::uint32_t next_{1};
};

}  // namespace hirosco::supervisor
