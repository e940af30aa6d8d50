// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/subsystem/service_loop/platform.hpp"
#include "supervisor/guard/guard.hpp"
#include "supervisor/platform/launch/descriptor_readings.hpp"
#include "supervisor/platform/launch/launcher.hpp"
#include "supervisor/platform/storage/log_readings.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/platform/storage/value_store.hpp"
#include "supervisor/supervision/members/member.hpp"
#include "supervisor/supervision/observer.hpp"
#include "supervisor/supervision/realtime_links/link_graph.hpp"
#include "supervisor/supervision/succession/journal.hpp"

namespace hirosco::supervisor {

struct SupervisorParts;

/// The superior subsystem (paper 4.3, figure 6): the life of its parts, one folder of supervision/ each. Thread: one, in which all are stepped.
class Supervisor final {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    Platform platform;
    ProcessLauncher& launcher;
    Guard& guard;  ///< stepped by its own thread, or by who steps the supervisor
    PacketLog& log;
    DatabaseOpener open_database;
    Observer& observer;
    std::uint16_t first_sequence_count{0};  ///< of its own telecommands (decision 27)
    Journal* journal{nullptr};  ///< what it knows, for one that goes on for it; null: nobody does
    ValueStore* values{nullptr};  ///< of persistent parameters; null: they do not outlive the flight
    LogReadings* log_readings{nullptr};  ///< for what ground missed; null: nothing comes down again
    DescriptorReadings* readings{nullptr};  ///< of what is read again; null: descriptors stay what they were
  };
  explicit Supervisor(const Parts& parts);
  ~Supervisor();

  /// Starts the subsystems of the mission and begins commissioning.
  void start();
  /// Goes on for a supervisor that died, with what still runs, in the place of start(). `stop_asked`: somebody asked for a stop
  /// meanwhile. Waits for no disk: stored values are read in the first step, when the guard's thread runs.
  void adopt(bool stop_asked);
  /// One step; returns when the next is due at the latest. Messages should wake it earlier.
  TimePoint step(TimePoint now);
  /// What it knew at the end of its newest step is noted for the next one, or nobody would go on for it.
  [[nodiscard]] bool remembers() const noexcept { return noted_; }
  /// Orderly shutdown: every subsystem back to Offline, then this one. `by`: who asks, as the log is to say it.
  void request_shutdown(std::string_view by = {});
  /// Whoever started it is alive and does not move: nobody would end what is left after this one.
  void keeper_stands_still();
  /// Whoever started it has ended before it: as above, and nobody would go on for it. The flight goes on.
  void keeper_lost();
  [[nodiscard]] bool finished() const noexcept;
  /// False when commissioning failed or the shutdown was not orderly.
  [[nodiscard]] bool succeeded() const noexcept;
  [[nodiscard]] bool commissioned() const noexcept;
  /// What commissioning waits for, or the shutdown once it has begun; empty when nothing.
  [[nodiscard]] std::string waiting_for() const;

  [[nodiscard]] const std::vector<Member>& members() const noexcept;
  /// As it is flown now: descriptors may have been read again.
  [[nodiscard]] const descriptor::Mission& mission() const noexcept;
  [[nodiscard]] const descriptor::Mode& mode() const noexcept;
  [[nodiscard]] const LinkGraph& links() const noexcept;
  [[nodiscard]] descriptor::State own_state() const noexcept;
  [[nodiscard]] MemberStatistics own_statistics() const noexcept;
  /// False while what a member sends has to wait: its channel is not to wake anybody.
  [[nodiscard]] bool reads(const Member& member) const;

 private:
  void note();

  std::unique_ptr<SupervisorParts> parts_;
  TimePoint next_watch_{};
  bool values_to_read_{false};
  bool noted_{false};
  bool not_noted_told_{false};
};

}  // namespace hirosco::supervisor
