// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/ground_route.hpp"
#include "supervisor/supervision/data_handling/traffic.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Logs every telemetry packet and routes it: to the ground, then to all parts that hear (paper 4.3). What the log sends down again (TM[129,12])
/// is routed to the ground only.
/// Thread: the supervisor's.
class Telemetry {
 public:
  Telemetry(Craft& craft, OwnSubsystem& own, Traffic& traffic, GroundRoute& ground, std::vector<Hearer*> hearers)
      : craft_{craft}, own_{own}, traffic_{traffic}, ground_{ground}, hearers_{std::move(hearers)} {}

  /// False: it cannot be read, or claims another sender than whose channel brought it (decision 2).
  [[nodiscard]] bool take(std::uint16_t from, Octets packet);
  /// What waits for the ground link goes on as soon as that takes it; what it could not take is told once a second.
  void serve_ground();
  [[nodiscard]] const GroundRoute& ground() const noexcept { return ground_; }
  /// There is a ground link that takes what is said.
  [[nodiscard]] bool ground_hears() { return to_ground() != nullptr; }

 private:
  /// Nullptr: it is not there, or in Offline.
  [[nodiscard]] Channel* to_ground();

  Craft& craft_;
  OwnSubsystem& own_;
  Traffic& traffic_;
  GroundRoute& ground_;
  std::vector<Hearer*> hearers_;
  GroundRoute::Lost lost_told_{};
  TimePoint next_loss_told_{};
};

}  // namespace hirosco::supervisor
