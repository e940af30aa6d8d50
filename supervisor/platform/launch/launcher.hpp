// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/os/stray_thread.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/platform/launch/member_port.hpp"

/// How subsystems come to life (architecture, rule 3). Real: one process each; simulated: objects of one process.
namespace hirosco::supervisor {

/// Processor time of the loops of a process, its cycle left out.
struct LoopTime {
  Duration service{};   ///< had by its service loop
  Duration realtime{};  ///< had by all loops that have real-time priority
  bool runnable{false}; ///< its service loop has the processor at this moment, or lacks nothing else
};

/// What can be done to a started process whatever it does itself. After its end nothing happens any more.
/// Realtime: system calls, bounded. Thread: any.
class ProcessGrip {
 public:
  virtual ~ProcessGrip() = default;
  /// Learns which threads it has now, by which loop_time() and take_loops_realtime() go until the next time. Realtime: no.
  virtual void find_threads() noexcept {}
  /// All its threads lose real-time priority: who waited for the processor gets it.
  virtual void take_realtime() noexcept = 0;
  /// The same, but its cycle keeps what it has.
  virtual void take_loops_realtime() noexcept = 0;
  /// What was taken is given back to each thread that had it and has none now.
  virtual void give_realtime() noexcept = 0;
  [[nodiscard]] virtual LoopTime loop_time() noexcept = 0;
  /// Processor time that all its threads have had so far.
  [[nodiscard]] virtual Duration processor_time() noexcept = 0;
  virtual void kill() noexcept = 0;
};

/// What the supervisor holds of a started subsystem.
struct LaunchedSubsystem {
  std::unique_ptr<MemberPort> port;  ///< for the boxes of the supervisor
  Mapping vital;  ///< for the guard, which needs nothing of the port; read
  Mapping permit;  ///< the same; written
  std::uint32_t process{0};  ///< names it to the launcher
  std::shared_ptr<ProcessGrip> grip;  ///< null where a process cannot be gripped
  std::string_view not_held{};  ///< what of it the mission's manifest does not hold; empty: all, or there is none
  std::string_view
      not_kept{};  ///< why it would end with this supervisor, where the keeper holds others; empty: it is held, or nobody is
  std::string_view not_isolated{};  ///< why this one is in no sandbox, where others are; empty: it is, or none is
};

/// A subsystem that goes on though the supervisor that had started it is gone (docs/adr/0093).
struct AdoptedSubsystem {
  LaunchedSubsystem
      launched;  ///< its permit page is a new one, which permits nothing yet and has the newest stop of the one before
  MemoryHandle permit;  ///< that page: the subsystem is to be handed it over its channel
  std::uint32_t epoch{0};  ///< of the page that it looks at so far
  bool permitted{false};  ///< by that page, under that epoch
  bool stopped{false};  ///< by that page
  std::uint32_t powered{0};  ///< Power, as that page says
};

/// Why nobody goes on with a subsystem.
struct NotAdopted {
  std::string why{};  ///< it lived, or nobody can tell, and was ended for this; empty: nothing of it ran
  std::uint32_t process{
      0};  ///< it has not gone yet: ended() tells when it has, and none is to be launched beside it; 0: it has
};

/// Why an executable is not started.
struct StartRefusal {
  Error why;  ///< for who asked
  std::string words;  ///< with names, what was found, and what to do
};

/// How a subsystem's process ended.
struct ProcessEnd {
  bool by_signal{false};
  int value{0};  ///< exit code or signal
};

/// Thread: the supervisor's.
class ProcessLauncher {
 public:
  virtual ~ProcessLauncher() = default;
  [[nodiscard]] virtual Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) = 0;
  /// What a supervisor before this one had started and still runs. One that lives and cannot be gone on with is ended: its permit page is one
  /// that nobody can write any more.
  [[nodiscard]] virtual std::expected<AdoptedSubsystem, NotAdopted> adopt(
      const descriptor::MissionSubsystem& /*subsystem*/) {
    return std::unexpected{NotAdopted{}};
  }
  /// It would not launch() it now, by the mission's manifest (docs/adr/0089); empty: it would, as far as that goes.
  [[nodiscard]] virtual std::optional<StartRefusal> refuse(const descriptor::MissionSubsystem& /*subsystem*/) {
    return std::nullopt;
  }
  /// Reads another version of its executable, which the mission's manifest lists as NAME@VERSION; the empty one is the mission's own.
  /// True: it is there; false: ask again. Does not wait.
  [[nodiscard]] virtual std::expected<bool, StartRefusal> prepare(const descriptor::MissionSubsystem& /*subsystem*/,
                                                                  const std::string& /*version*/) {
    return std::unexpected{StartRefusal{{ErrorCode::Unavailable, "this flight has no manifest, which lists versions"},
                                        "this flight has no manifest, which lists versions"}};
  }
  /// What it launches of this subsystem from now on.
  virtual void use(const descriptor::MissionSubsystem& /*subsystem*/, const std::string& /*version*/) {}
  /// It is not used any more: its memory is given back.
  virtual void drop(const descriptor::MissionSubsystem& /*subsystem*/, const std::string& /*version*/) {}
  /// What an address of `fresh` needs that the process of `flown`, which runs, can be let in to no more; empty: nothing.
  [[nodiscard]] virtual std::string shut_out(std::uint32_t /*process*/, const descriptor::MissionSubsystem& /*flown*/,
                                             const descriptor::MissionSubsystem& /*fresh*/) {
    return {};
  }
  /// Lets a process that runs in to all addresses of `fresh`, beside those that it has (docs/adr/0236). In words: what it does not get, and
  /// why; then keep_in() with what it flies by takes back what it got. Empty: nothing.
  [[nodiscard]] virtual std::string let_in(std::uint32_t /*process*/, const descriptor::MissionSubsystem& /*fresh*/) {
    return {};
  }
  /// It keeps the addresses that `now` names, and no others. In words: what it reaches all the same, and why; empty: nothing.
  [[nodiscard]] virtual std::string keep_in(std::uint32_t /*process*/, const descriptor::MissionSubsystem& /*now*/) {
    return {};
  }
  /// What the sandbox of this subsystem cannot narrow down, in words; empty: nothing (docs/adr/0150).
  [[nodiscard]] virtual std::string left_open(const descriptor::MissionSubsystem& /*subsystem*/) const { return {}; }
  /// Empty while it runs.
  [[nodiscard]] virtual std::optional<ProcessEnd> ended(std::uint32_t process) = 0;
  virtual void kill(std::uint32_t process) = 0;
  /// Why it would end with this supervisor though that has handed it over to the keeper; empty: it would not. Told once for each process, a
  /// moment after it was launched or adopted.
  [[nodiscard]] virtual std::string_view take_not_kept(std::uint32_t /*process*/) { return {}; }
  /// What those that it starts are not kept from, in words; empty: they are isolated (docs/adr/0081).
  [[nodiscard]] virtual std::vector<std::string> isolation_lacks() const { return {}; }
  /// What would isolate them more and the mission does not ask for, in words; empty: nothing (docs/adr/0177).
  [[nodiscard]] virtual std::string isolation_not_asked() const { return {}; }
  /// What it has taken, as it was seen last, and it is looked at again; 0 of what cannot be told of it alone; empty where nothing can, it
  /// was not seen yet, or has ended. Allocates nothing.
  [[nodiscard]] virtual std::optional<ProcessUsage> usage(std::uint32_t /*process*/) noexcept { return std::nullopt; }
  /// Whether the computer has this core for us (docs/adr/0234). Where time is simulated each is as good as another.
  [[nodiscard]] virtual bool grants_core(std::uint16_t /*core*/) noexcept { return true; }
  /// A thread of it that is not where it may be, as it was seen last; empty: none, or nobody can tell. Allocates nothing.
  [[nodiscard]] virtual std::optional<StrayThread> stray(std::uint32_t /*process*/,
                                                         const ThreadPlaces& /*places*/) noexcept {
    return std::nullopt;
  }
  /// Memory that a process has in RAM, 0 = the supervisor's own; 0 where it has no process of its own or has ended.
  /// Allocates nothing.
  [[nodiscard]] virtual std::uint32_t resident_kb(std::uint32_t /*process*/) noexcept { return 0; }
};

}  // namespace hirosco::supervisor
