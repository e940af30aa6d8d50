// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "simulation/spacecraft/simulated_ground.hpp"

namespace hirosco::simulation {

/// How a telecommand of the simulated ground ended.
struct CommandOutcome {
  bool accepted{false};
  bool started{false};
  int progress_reports{0};
  bool completed{false};
  std::optional<pus::FailureCode> failure;
  std::uint8_t failure_subtype{0};
};

/// Writes the ground's telecommands by the names of their requests, and counts them.
class NamedCommands {
 public:
  explicit NamedCommands(const descriptor::Mission& mission) : mission_{mission} {}

  /// Asks for all acknowledgements. Arguments stand in declared order, arrays element by element.
  /// \return the packet; empty: there is no such request, or it does not take them.
  [[nodiscard]] std::vector<std::byte> write(std::string_view subsystem, std::string_view name,
                                             const std::vector<Value>& arguments);

 private:
  const descriptor::Mission& mission_;
  std::uint16_t sequence_{0};
};

/// Hears on ground how a telecommand ends, as long as it is there. One at a time: nobody else is told what comes down meanwhile, or from then on.
class FollowedCommand {
 public:
  FollowedCommand(SimulatedGround& ground, Octets packet);
  ~FollowedCommand();
  FollowedCommand(const FollowedCommand&) = delete;
  FollowedCommand& operator=(const FollowedCommand&) = delete;

  [[nodiscard]] bool over() const noexcept { return outcome_.completed || outcome_.failure.has_value(); }
  [[nodiscard]] const CommandOutcome& outcome() const noexcept { return outcome_; }

 private:
  void receive(Octets packet);

  SimulatedGround& ground_;
  std::uint32_t request_id_;
  CommandOutcome outcome_;
};

}  // namespace hirosco::simulation
