// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "supervisor/platform/launch/flight_launcher.hpp"

namespace hirosco::supervisor {

/// The second deployment in real time (docs/adr/0097): each subsystem is two threads of this process. No process is started, no
/// descriptor is handed over, nothing is sealed. Its cycle and its service loop have the priorities that they have as a process.
///
/// A thread cannot be ended from outside. Who is to be ended is fenced by the guard as ever, loses its real-time priority, and is told to
/// let go: it does so as soon as it comes back from its author's code. Until then it has not ended, nobody starts it again, and after
/// `patience` the flight as a whole must end. An exception that leaves its author's code in the service loop ends it alone.
class ThreadLauncher final : public FlightLauncher {
 public:
  /// Makes the author's object of an executable of the mission, in the member's own thread.
  using Makers = std::map<std::string, std::function<std::unique_ptr<Subsystem>()>, std::less<>>;
  /// What one that was told to let go may take for it.
  static constexpr Duration patience = std::chrono::seconds{2};

  struct Parts {
    const Clock& clock;
    FlowFactory& flows;
    Makers makers;
    bool realtime{true};  ///< the loops may have real-time priorities
    LinkMechanisms links;
    /// A line of a member, with its name. Thread: any.
    std::function<void(std::string_view)> explain{};
  };
  explicit ThreadLauncher(Parts parts);
  /// Tells all to let go, and waits until they have.
  ~ThreadLauncher() override;

  /// The memory that its members share with the supervisor.
  [[nodiscard]] MemoryProvider& memory() noexcept { return memory_; }

  [[nodiscard]] std::expected<std::string, std::string> begin(const descriptor::Mission& mission) override;
  /// Unavailable: an earlier thread of it has not let go. NotFound: nobody makes it.
  [[nodiscard]] Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) override;
  [[nodiscard]] std::optional<ProcessEnd> ended(std::uint32_t process) override;
  void kill(std::uint32_t process) override;
  /// What a mission wants and threads cannot have, too: after begin() with it.
  [[nodiscard]] std::vector<std::string> isolation_lacks() const override;
  /// Processor time of its loops, and nothing else: the rest cannot be told apart in one process.
  [[nodiscard]] std::optional<ProcessUsage> usage(std::uint32_t process) noexcept override;
  void kill_all() override;
  [[nodiscard]] bool any_running() override;
  [[nodiscard]] int wait_descriptor(std::uint32_t process) override;
  [[nodiscard]] std::optional<std::string> must_end(TimePoint now) override;

 private:
  struct Member;
  class Grip;

  Parts parts_;
  HeapMemory memory_;
  std::map<std::uint32_t, std::shared_ptr<Member>> members_;
  std::map<std::string, Mapping, std::less<>> vital_;  ///< newest page of each subsystem, outlives its threads
  std::optional<descriptor::UserNumbers> users_;  ///< that the mission names
  std::uint32_t next_{1};
};

}  // namespace hirosco::supervisor
