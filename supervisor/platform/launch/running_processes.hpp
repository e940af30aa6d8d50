// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/platform/launch/launcher.hpp"
#include "supervisor/platform/launch/process_watch.hpp"

namespace hirosco::supervisor {

/// Processes that have not been seen to end, each by a number that no other one gets: what they take, and how they end.
/// Thread: the supervisor's.
class RunningProcesses {
 public:
  /// The keeper's page tells how those ended whose parent was a supervisor before; null: nobody does.
  void ends_told_by(const KeeperPage* page) noexcept { page_ = page; }
  /// \param handle Another one of its, for who looks at it from now on.
  /// \param grip Learns of its threads by that; may be null.
  /// \return its number.
  std::uint32_t add(Process process, FileDescriptor handle, std::shared_ptr<ProcessGrip> grip);
  /// It is killed, with its group. \return 0, or by which number it is still to be seen to its end.
  std::uint32_t end_now(Process process);
  /// Nullptr: it has been seen to end, or is none of them.
  [[nodiscard]] const Process* find(std::uint32_t number) const;

  /// Empty while it runs. One that is none of them has ended. Whom it has left behind in its group goes with it.
  [[nodiscard]] std::optional<ProcessEnd> ended(std::uint32_t number);
  void kill(std::uint32_t number);
  void kill_all();
  [[nodiscard]] bool any();

  /// As its looks say (ProcessWatch).
  [[nodiscard]] ProcessWatch& watch() noexcept { return watch_; }
  /// Memory that it has in RAM as it was seen last, 0 = we ourselves; 0 where it has ended. Allocates nothing.
  [[nodiscard]] std::uint32_t resident_kb(std::uint32_t number) noexcept;

 private:
  std::map<std::uint32_t, Process> processes_;
  Result<ProcessMeter> own_{ProcessMeter::own()};
  ProcessWatch watch_;
  const KeeperPage* page_{nullptr};
  std::map<std::uint32_t, TimePoint> end_asked_;  ///< of processes that have ended, and nobody has said how
  std::uint32_t next_{1};
};

}  // namespace hirosco::supervisor
