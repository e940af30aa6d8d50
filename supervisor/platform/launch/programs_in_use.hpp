// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "hirosco/descriptor/model/mission.hpp"
#include "supervisor/platform/launch/held_programs.hpp"
#include "supervisor/platform/launch/interpreter.hpp"
#include "supervisor/platform/launch/launcher.hpp"

namespace hirosco::supervisor {

/// Which program is started of each subsystem: of its version in use what the mission's manifest lists, or without a manifest the
/// file of its name. Thread: the supervisor's.
class ProgramsInUse {
 public:
  struct Found {
    std::filesystem::path file;
    std::optional<Interpreter> interpreter{};  ///< nothing: it is no script
    const ProgramImage* image{nullptr};  ///< null: there is no manifest
  };
  /// From now on what the manifest of this mission lists, and nothing else. Reads all of it first.
  const HeldPrograms& hold_to(const descriptor::Mission& mission);
  /// The same beside a flight: nobody waits for what is read. Until a program is there find() and refuse() say that it is still being read.
  void hold_to_beside(const descriptor::Mission& mission);
  [[nodiscard]] bool has_manifest() const noexcept { return held_ != nullptr; }

  [[nodiscard]] Result<Found> find(const descriptor::MissionSubsystem& subsystem);
  /// What was found could not be started: it may be elsewhere by now.
  void look_again(const descriptor::MissionSubsystem& subsystem) { files_.erase(subsystem.executable); }
  /// What the manifest has against it; empty: nothing, or there is none.
  [[nodiscard]] std::optional<StartRefusal> refuse(const descriptor::MissionSubsystem& subsystem);
  /// Of a mission with a manifest, as ProcessLauncher::prepare(), use() and drop().
  [[nodiscard]] std::expected<bool, StartRefusal> prepare(const descriptor::MissionSubsystem& subsystem,
                                                          const std::string& version);
  void use(const descriptor::MissionSubsystem& subsystem, const std::string& version);
  void drop(const descriptor::MissionSubsystem& subsystem, const std::string& version);

 private:
  [[nodiscard]] std::string name_of(const descriptor::MissionSubsystem& subsystem) const;

  std::unique_ptr<HeldPrograms> held_;  ///< null: the mission has no manifest
  std::map<std::string, std::string, std::less<>> versions_;  ///< by subsystem, where it is not the mission's own
  /// Without one: where each executable was found, and what it is: a disk is not asked again in flight, where it might hang.
  std::map<std::string, Found, std::less<>> files_;
};

}  // namespace hirosco::supervisor
