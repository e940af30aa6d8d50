// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/octets.hpp"
#include "simulation/campaign/world_trace.hpp"
#include "simulation/spacecraft/spacecraft.hpp"

namespace hirosco::campaign {

/// The packets that a plan has its origins send, and what ground receives: each stands in the trace.
class FlightTraffic {
 public:
  /// An origin; the others are subsystems, by name.
  static constexpr const char* ground = "ground";

  struct Header {
    std::uint16_t apid{};
    std::uint8_t service{};
    std::uint8_t subtype{};
    std::uint8_t ack{};
  };
  /// What ground heard of the end of a request of its own.
  struct Verdict {
    bool over{false};
    bool completed{false};
  };

  FlightTraffic(const descriptor::Mission& mission, simulation::Spacecraft& craft, WorldTrace& trace);
  FlightTraffic(const FlightTraffic&) = delete;
  FlightTraffic& operator=(const FlightTraffic&) = delete;

  /// A telecommand with this origin's next count. False: there can be none, or it is lost.
  bool send(const std::string& origin, const Header& header, Octets data);
  /// Octets as they are. False: they are lost.
  bool send_packet(const std::string& origin, Octets packet);
  /// Of the newest that send() has made.
  [[nodiscard]] std::uint32_t last_request() const noexcept { return last_request_; }
  [[nodiscard]] Verdict verdict(std::uint32_t request) const;

 private:
  void received_on_ground(Octets packet);

  const descriptor::Mission& mission_;
  simulation::Spacecraft& craft_;
  WorldTrace& trace_;
  std::map<std::string, std::uint16_t> counts_;  ///< of the telecommands of each origin
  std::map<std::uint32_t, Verdict> verdicts_;    ///< of the ground's, by request id
  std::uint32_t last_request_{0};
};

}  // namespace hirosco::campaign
