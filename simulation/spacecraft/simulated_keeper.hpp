// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "supervisor/keeper/inhibit_bridge.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/supervision/succession/journal.hpp"

namespace hirosco::simulation {

/// What a keeper holds that outlives the supervisor, and what it does while there is none (docs/adr/0093).
class SimulatedKeeper {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    FlowFactory& flows;
    std::optional<Duration> revives_after;  ///< a death; empty: nobody goes on
    std::size_t journal_octets;
  };
  explicit SimulatedKeeper(const Parts& parts);
  SimulatedKeeper(const SimulatedKeeper&) = delete;
  SimulatedKeeper& operator=(const SimulatedKeeper&) = delete;

  [[nodiscard]] supervisor::KeeperPage& page() noexcept { return *page_; }
  /// Null: nobody goes on, so nothing is noted.
  [[nodiscard]] supervisor::Journal* journal() noexcept { return journal_ ? &*journal_ : nullptr; }
  [[nodiscard]] MutableOctets journal_memory() noexcept { return journal_memory_; }

  /// Another supervisor is made.
  void count_start();
  /// Supervisors that were made.
  [[nodiscard]] std::uint32_t starts() const noexcept { return page_->starts.load(); }
  /// Stops asked for beside telecommands, as the newest supervisor has them.
  [[nodiscard]] supervisor::AskedStops& stops() noexcept { return *stops_; }

  /// A supervisor that dies is gone on for.
  [[nodiscard]] bool revives() const noexcept { return revives_after_.has_value(); }
  /// The supervisor has died.  \param pause Until the next one, in place of what it mostly is.
  /// \return when another one goes on; until then step() is due from now on. Empty: nobody does.
  std::optional<TimePoint> lose_supervisor(TimePoint now, std::optional<Duration> pause = {});
  /// Tells each device what the guard told it last.  \return when it is due again.
  TimePoint step(TimePoint now);
  /// The next supervisor's guard is about to take the devices over.
  void give_back(TimePoint now);
  /// There is no guard to stop all: nothing is enabled any more.
  void stop_all() noexcept { bridge_->stop(); }

 private:
  std::optional<Duration> revives_after_;
  std::unique_ptr<supervisor::KeeperPage> page_{std::make_unique<supervisor::KeeperPage>()};
  std::optional<supervisor::AskedStops> stops_;
  std::vector<std::byte> journal_memory_;
  std::optional<supervisor::Journal> journal_;
  std::optional<supervisor::InhibitBridge> bridge_;
};

}  // namespace hirosco::simulation
