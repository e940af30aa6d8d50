// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hirosco/data_transfer/channel.hpp"
#include "hirosco/data_transfer/memory.hpp"
#include "hirosco/descriptor/mission.hpp"
#include "hirosco/utilities/result.hpp"

/// How subsystems come to life (architecture, rule 3). Real: one process each; simulated: objects of one process.
namespace hirosco::supervisor {

/// What the supervisor holds of a started subsystem.
struct LaunchedSubsystem {
  std::unique_ptr<Channel> channel;
  Mapping vital;                     ///< read
  Mapping permit;                    ///< written
  std::uint32_t process{0};          ///< names it to the launcher
};

/// How a subsystem's process ended.
struct ProcessEnd {
  bool by_signal{false};
  int value{0};                      ///< exit code or signal
};

/// Thread: the supervisor's.
class ProcessLauncher {
 public:
  virtual ~ProcessLauncher() = default;
  [[nodiscard]] virtual Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) = 0;
  /// Empty while it runs.
  [[nodiscard]] virtual std::optional<ProcessEnd> ended(std::uint32_t process) = 0;
  virtual void kill(std::uint32_t process) = 0;
  /// Memory that a process has in RAM, 0 = the supervisor's own; 0 where it has no process of its own or has ended.
  /// Allocates nothing.
  [[nodiscard]] virtual std::uint32_t resident_kb(std::uint32_t /*process*/) noexcept { return 0; }
};

}  // namespace hirosco::supervisor
