// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/process_threads.hpp"
#include "hirosco/utilities/os/processor_set.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// How a process ended.
struct ExitStatus {
  enum class Kind : std::uint8_t {
    Exited,    ///< `value` is its exit code
    Signalled, ///< `value` is the signal that ended it
    Unknown,   ///< it ended, but it was not our child, so its parent was told and we were not
  };
  Kind kind{Kind::Unknown};
  int value{0};
  [[nodiscard]] bool success() const noexcept { return kind == Kind::Exited && value == 0; }
  friend bool operator==(const ExitStatus&, const ExitStatus&) = default;
};

/// What a started process may take; what is empty is as it is for us. Beyond it the system refuses it, whatever it tries.
struct ProcessLimits {
  std::optional<std::uint64_t> memory_octets{};  ///< that it may write and shares with nobody
  std::optional<std::uint64_t> descriptors{};
  /// The highest of real time that its threads may take; less where we have less ourselves. Root's right to all of them ends in a sandbox
  /// only.
  std::optional<std::uint64_t> realtime_priority{};
  /// That its threads begin with; where the computer has none of them it is not started.
  std::optional<ProcessorSet> processors{};
  /// Where memory ends, the system ends a process: this one before those that are not so marked, as if it had half the computer's memory more.
  bool goes_first{false};
};

/// What to start.
struct ProcessStart {
  /// A descriptor of ours that the new process finds under `number`.
  struct Inherited {
    int ours{-1};
    int number{-1};
  };
  std::string executable{};  ///< path; not searched for
  /// A descriptor of ours whose file is executed in place of whatever has that path by then; the path is argv[0] only. A script
  /// needs it among `inherited`, too: its interpreter reads it from there.
  std::optional<int> image{};
  std::vector<std::string> arguments{};  ///< without the executable's own name, which becomes argv[0]
  std::vector<Inherited> inherited{};  ///< besides 0, 1 and 2, the new process has these descriptors and no others
  std::optional<std::vector<std::string>> environment{};  ///< "NAME=value"; ours when absent
  std::string working_directory{};  ///< ours when empty
  /// Signals that it begins with as blocked: it takes them up itself, and none ends it before it can.
  std::vector<int> blocked{};
  ProcessLimits limits{};
  const PreparedSandbox* sandbox{nullptr};  ///< null: none; outlives the call
  /// A user and a group of this number, in no other group and without our rights, in place of what we are. Needs own_user.hpp's.
  std::optional<std::uint32_t> user{};
  bool over_users{
      false};  ///< it may start others as users of their own and end them, as far as we may; else only as root
};

/// A process in a group of its own. It outlives this object and this process: nothing here kills it but send_signal() and kill_with_its_own().
/// Whoever starts processes keeps the Process until poll() has returned its end, or a zombie stays.
/// Realtime: blocks. Thread: one at a time.
class Process {
 public:
  /// Starts an executable; an executable that cannot be started is an error here, not an exit later, unless its disk takes longer
  /// than 0.3 s to say so. It begins with no ignored signals, no blocked ones but those named, and ordinary scheduling.
  [[nodiscard]] static Result<Process> spawn(const ProcessStart& start);
  /// Takes over a process that somebody else started.
  [[nodiscard]] static Result<Process> adopt(int pid) noexcept;
  [[nodiscard]] static Result<Process> adopt(int pid, FileDescriptor handle) noexcept;

  [[nodiscard]] int pid() const noexcept { return pid_; }
  /// Readable once the process has ended: for WaitSet, or to hand to another process.
  [[nodiscard]] const FileDescriptor& handle() const noexcept { return handle_; }
  /// Its end, or nothing while it runs; does not block, and repeats its answer. A child is collected by
  /// it, or stays a zombie where collect() does not go.
  [[nodiscard]] Result<std::optional<ExitStatus>> poll() noexcept;
  /// Never hits another process that got the same pid later; NotFound when it has ended.
  [[nodiscard]] Result<> send_signal(int signal) noexcept;
  /// Ends it, and whom it has started in its group: they do not go on without it. Of one that has ended already, those that it has left
  /// behind, where the system tells them from others (Linux 6.9); never another process or group that got the same number later.
  void kill_with_its_own() noexcept;

 private:
  Process(int pid, FileDescriptor handle) noexcept : pid_{pid}, handle_{std::move(handle)} {}
  int pid_;
  FileDescriptor handle_;
  std::optional<ExitStatus> ended_;
};

/// What became of a child that was to be collected.
enum class Collection : std::uint8_t {
  Begun,  ///< it is, or is in a moment
  UnderWay,  ///< it was begun before, or is done
  NotNow,  ///< too many are under way, or no thread is to be had: to be tried again
};

/// Takes a child that has ended, or is about to, from the system, by which its number is free again. Whoever has real time leaves that to a
/// thread that has none: the system may hold whoever does it for as long as another one of this processor, who has just looked at the
/// child, does not come to go on (docs/adr/0240). Until then it can be seen in /proc, and does nothing.
/// Realtime: bounded; else blocks until it has ended. Thread: any.
[[nodiscard]] Collection collect(int pid) noexcept;
/// Whoever has real time and children calls this before he has either: later the thread may not be to be had.
[[nodiscard]] Result<> begin_collecting() noexcept;

/// Of a process that is ending: its threads come before all ordinary ones and after everything of real time, so that on a busy computer, too,
/// it gives back soon what it holds; but those in the background, who come after everybody. Where that is not permitted it takes its time. Realtime: system calls, bounded.
void hurry_end(ProcessThreads& threads) noexcept;

}  // namespace hirosco
