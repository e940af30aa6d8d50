// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hirosco {

/// Which sockets a process may make (docs/adr/0150); by itself none.
struct SandboxSockets {
  bool local{false};  ///< UNIX, to whatever has a path and permits it
  bool datagrams{false};  ///< UDP, from and to everywhere
  bool streams{false};  ///< TCP, from and to everywhere
  std::vector<std::uint16_t> ports{};  ///< of others that it may connect to by TCP, wherever they are
  bool own_port{
      false};  ///< one that the system chooses may be its own end of TCP, as at an address of the craft's network
  friend bool operator==(const SandboxSockets&, const SandboxSockets&) = default;
};

/// How a system call is refused.
enum class CallRefusal : std::uint8_t {
  Signal,  ///< SIGSYS: it is named (name_refused_calls()) and fails with EPERM, or the process is ended
  Error,   ///< it fails with EPERM: for a program that does not have it named (docs/adr/0210)
};

/// What of its computer a started process reaches (docs/adr/0081). Files and folders with all below; what is not there counts as
/// not named.
struct Sandbox {
  std::vector<std::string> readable;
  std::vector<std::string> executable;
  std::vector<std::string> writable;  ///< also made and removed, and read
  SandboxSockets sockets{};
  bool queues{false};  ///< POSIX message queues, whosever of its user
  std::vector<std::string> listable{};  ///< folders: the names in them, and nothing of what bears them
  CallRefusal refusal{CallRefusal::Signal};
};

/// What this computer or build cannot keep a process from, in words; empty: all of it.
[[nodiscard]] std::vector<std::string> isolation_lacks();

/// Nothing is isolated: built with a sanitizer, which needs what a sandbox refuses, or HIROSCO_SANDBOX=off in the environment, for
/// tools that look into processes or have them write files.
[[nodiscard]] bool sandbox_is_off() noexcept;
/// Whoever flies wants none, by HIROSCO_SANDBOX=off: a debugger that begins its subsystem itself, or a program that begins others.
[[nodiscard]] bool sandbox_is_unwanted() noexcept;

/// A sandbox made ready, to be entered between fork and exec. No way leads out of it, for nothing that is started in it either: no new
/// rights, of root's rights those only that real time needs, files as Sandbox says, signals, memory, scheduling and limits of nobody outside,
/// sockets as Sandbox says, and no system calls that no subsystem needs, among them those that start a process.
class PreparedSandbox {
 public:
  /// Touches no file: a disk that stands still holds up who enters, and nobody else.
  explicit PreparedSandbox(Sandbox sandbox) noexcept : sandbox_{std::move(sandbox)} {}
  /// 0, or the system's error number. Files are left open where the system cannot refuse them (isolation_lacks()).  Async-signal-safe.
  [[nodiscard]] int enter() const noexcept;

 private:
  Sandbox sandbox_;
};

/// From now on each system call that the sandbox refuses is named on standard error, at most ten times, and fails with EPERM; without this
/// it ends the process, as long as it is refused by a signal.
void name_refused_calls(const char* program) noexcept;

}  // namespace hirosco
