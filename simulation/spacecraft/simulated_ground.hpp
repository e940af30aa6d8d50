// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "hirosco/subsystem/author/ground_transport.hpp"

/// A ground station without sockets: what it sends arrives at the mission's ground link, what that sends arrives here.
namespace hirosco::simulation {

class SimulatedGround {
 public:
  /// For the subsystem that holds the ground link: opens the on-board end. One at a time.
  [[nodiscard]] OpenGroundTransport transport();
  /// False: its station goes away, and nobody is connected to the end that is open or to those after it, until it comes again.
  void is_there(bool there);
  /// Sends a telecommand packet up; lost, and false, while the on-board end is closed, as on a dead link, or the station away.
  bool send(Octets packet);
  /// Called for every packet that comes down.
  void on_telemetry(std::function<void(Octets)> receive) { receive_ = std::move(receive); }

 private:
  class OnBoardEnd;
  OnBoardEnd* end_{nullptr};
  bool there_{true};
  std::function<void(Octets)> receive_;
};

}  // namespace hirosco::simulation
