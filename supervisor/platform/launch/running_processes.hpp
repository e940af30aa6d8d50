// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/platform/launch/launcher.hpp"

namespace hirosco::supervisor {

/// Processes that have not been seen to end, each by a number that no other one gets: what they take, and how they end.
/// Thread: the supervisor's.
class RunningProcesses {
 public:
  /// The keeper's page tells how those ended whose parent was a supervisor before; null: nobody does.
  void ends_told_by(const KeeperPage* page) noexcept { page_ = page; }
  /// \return its number. What it takes is measured from now on.
  std::uint32_t add(Process process);
  /// It is killed, with its group. \return 0, or by which number it is still to be seen to its end.
  std::uint32_t end_now(Process process);
  /// Nullptr: it has been seen to end, or is none of them.
  [[nodiscard]] const Process* find(std::uint32_t number) const;

  /// Empty while it runs. One that is none of them has ended. Whom it has left behind in its group goes with it.
  [[nodiscard]] std::optional<ProcessEnd> ended(std::uint32_t number);
  void kill(std::uint32_t number);
  void kill_all();
  [[nodiscard]] bool any();

  /// Empty: it has ended, or is not measured. Allocates nothing.
  [[nodiscard]] std::optional<ProcessUsage> usage(std::uint32_t number) noexcept;
  /// Memory that it has in RAM, 0 = we ourselves; 0 where it has ended. Allocates nothing.
  [[nodiscard]] std::uint32_t resident_kb(std::uint32_t number) const noexcept;

 private:
  std::map<std::uint32_t, Process> processes_;
  std::map<std::uint32_t, FileDescriptor> memory_use_;  ///< statm of each process, and our own
  std::map<std::uint32_t, ProcessMeter> meters_;
  const KeeperPage* page_{nullptr};
  std::map<std::uint32_t, TimePoint> end_asked_;  ///< of processes that have ended, and nobody has said how
  std::uint32_t next_{1};
};

}  // namespace hirosco::supervisor
