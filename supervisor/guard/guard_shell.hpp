// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/wait_set.hpp"
#include "supervisor/guard/guard.hpp"

namespace hirosco::supervisor {

/// A first stop waits for no page of this program to come from a disk: its code is in memory, and what it has used stays there.
/// Where the system refuses that, all goes on without.
void keep_code_in_memory() noexcept;

/// The guard's thread, above every cycle, and its own two ways in, neither of which passes the ground link or the
/// supervisor's loop: signal SIGUSR1, and the local socket `safe.socket` (SOCK_SEQPACKET; "SAFE" is answered with one line
/// for everybody who was to stop, and a last one: safe_answer.hpp).
class GuardShell {
 public:
  /// Above all cycles (1 to 89), below the kernel's own.
  static constexpr int priority = 90;
  /// What is done in the guard's thread besides, or in place of what it does by itself; either may be empty.
  struct Calls {
    std::function<void()> on_begin{};  ///< before its first step
    std::function<std::uint64_t()>
        stop{};  ///< asked for by signal or socket, named as Guard::stop_all() does; empty: the guard stops all
  };
  /// An empty `folder`: no socket. SIGUSR1 must be blocked in the process. SystemFailure: socket, thread.
  [[nodiscard]] static Result<std::unique_ptr<GuardShell>> start(Guard& guard, const Clock& clock,
                                                                 const std::filesystem::path& folder, Calls calls);
  ~GuardShell();
  GuardShell(const GuardShell&) = delete;
  GuardShell& operator=(const GuardShell&) = delete;

 private:
  struct Client {
    FileDescriptor socket;
    TimePoint until{};  ///< it asks by then or goes
    std::uint64_t stop{0};  ///< 0: it has not asked yet
    std::vector<std::string> answer{};  ///< empty: it is not known yet
    std::size_t said{0};  ///< of its lines
  };
  GuardShell(Guard& guard, const Clock& clock, WakeEvent ending)
      : guard_{guard}, clock_{clock}, ending_{std::move(ending)} {}
  [[nodiscard]] Result<> listen(const std::filesystem::path& folder);
  void run();
  /// False: the system has no descriptor for it.
  [[nodiscard]] bool welcome(TimePoint now);
  std::uint64_t stop() { return calls_.stop ? calls_.stop() : guard_.stop_all(GuardFinding::Kind::StopAsked); }
  void hear(Client& client);
  void answer_clients(TimePoint now);
  void say(Client& client, TimePoint now);
  /// Somebody who has its answer, but no room for it yet.
  [[nodiscard]] bool has_more_to_say() const noexcept;

  Guard& guard_;
  const Clock& clock_;
  std::filesystem::path socket_path_;
  Calls calls_;
  FileDescriptor signals_;
  FileDescriptor listener_;
  std::vector<Client> clients_;
  WaitSet waits_;
  WakeEvent ending_;
  std::atomic<bool> ended_{false};
  Thread thread_;
};

}  // namespace hirosco::supervisor
