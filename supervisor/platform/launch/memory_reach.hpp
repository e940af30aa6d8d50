// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "hirosco/data_transfer/device/own_flow_access.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "supervisor/platform/launch/spare_folders.hpp"

namespace hirosco::supervisor {

/// Which device addresses in shared memory each process reaches that runs, and how it comes to others without being started anew (docs/adr/0236):
/// a sandbox is what it is from its start on, and what is at an address is not.
/// Thread: the supervisor's.
class MemoryReach {
 public:
  /// \param instance Of the flight.
  explicit MemoryReach(std::string instance) : instance_{std::move(instance)} {}

  /// For a process that is about to start: as many as its subsystem has addresses, by whichever means, as each may become one in memory.
  /// `sandbox` lets it in.
  [[nodiscard]] SpareFolders make_spares(const descriptor::MissionSubsystem& subsystem, Sandbox& sandbox) const;
  /// It runs. \param in_sandbox Or it reaches all that its user does.
  void began(std::uint32_t process, int pid, const descriptor::MissionSubsystem& subsystem, SpareFolders spares,
             bool in_sandbox);
  /// It runs, and a supervisor before had started it.
  void goes_on(std::uint32_t process, int pid, const descriptor::MissionSubsystem& subsystem);
  void ended(std::uint32_t process);

  /// Adds to `had` what of `fresh` the process can be let in to as it runs.
  void add_possible(std::uint32_t process, const descriptor::MissionSubsystem& fresh, Sandbox& had) const;
  /// Lets it in to what `fresh` names, beside what it has. In words: the first folder that it does not get, and why; empty: all.
  /// \param own Of a subsystem that is a user of its own.
  [[nodiscard]] std::string let_in(std::uint32_t process, const descriptor::MissionSubsystem& fresh,
                                   const std::optional<OwnGroup>& own);
  /// Of what it was let in to it keeps what `now` names. In words: which folder it reaches all the same, and why; empty: none.
  [[nodiscard]] std::string keep_in(std::uint32_t process, const descriptor::MissionSubsystem& now);

 private:
  struct OfProcess {
    bool in_sandbox{true};
    std::set<std::string> folders;
    SpareFolders spares;
  };
  [[nodiscard]] std::set<std::string> folders_of(const descriptor::MissionSubsystem& subsystem) const;
  [[nodiscard]] bool is_anothers(std::uint32_t process, const std::string& folder) const;

  std::string instance_;
  std::map<std::uint32_t, OfProcess> processes_;
};

}  // namespace hirosco::supervisor
