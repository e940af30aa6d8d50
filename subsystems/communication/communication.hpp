// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "hirosco/subsystem/author/ground_link.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/communication/told_ends.hpp"

namespace hirosco {

/// The ground link (paper 4.3, 5), by TCP or on a transport that is given. A subsystem that is one and something besides inherits it; each
/// function that it has itself calls the one here first.
class Communication : public Subsystem {
 public:
  explicit Communication(OpenGroundTransport open);

 protected:
  Result<Step> software_init() override;
  Result<> configure(const descriptor::Configuration& configuration) override;
  Result<> pre_operational(const Cycle&) noexcept override { return show(); }
  Result<> safe_operational(const Cycle&) noexcept override { return show(); }
  Result<> operational(const Cycle&) noexcept override { return show(); }
  Result<> error_operational(const Cycle&) noexcept override { return show(); }
  /// What clients have already handed to us is the supervisor's to answer, and listeners wait for that answer: the link
  /// closes when all is taken. What is not in time is counted and told, at least to the log.
  Result<Step> hardware_deinit() override;
  void service(TimePoint now) override;
  [[nodiscard]] ServiceWake service_wake() const override { return closing_since_ ? ServiceWake{} : ground_.wake(); }
  void telemetry(Octets packet) override;

  Event<> ground_link_lost_{"GROUND_LINK_LOST"};
  Event<> ground_link_restored_{"GROUND_LINK_RESTORED"};
  /// Who is not heard for so long is told of.
  static constexpr Duration ground_patience = 2s;

 private:
  // Structures of communication.xml: same members, same order.
  struct Link {
    std::uint8_t connected;
    std::uint32_t rx;
    std::uint32_t tx;
    std::uint32_t held_back;
    std::uint32_t last_rx_ms;
  };
  struct Clients {
    std::uint32_t accepted;
    std::uint32_t cut_slow;
    std::uint32_t evicted;
    std::uint32_t bad_header;
    std::uint32_t bad_length;
    std::uint32_t incomplete;
    std::uint32_t left;
    std::uint32_t broken;
    std::uint32_t refused;
    std::uint32_t idle_packets;
    std::uint32_t damaged_packets;
    std::uint32_t dropped;
  };

  void count(TimePoint now);
  void tell_cuts(TimePoint now);
  Result<> show() noexcept;

  std::array<Quota::Held, 2> ports_;  ///< that it listens at; given back after it
  GroundLink ground_;
  Event<std::uint8_t, std::uint32_t> client_cut_{"CLIENT_CUT"};  ///< reason, clients
  Event<std::uint32_t> telecommands_dropped_{"TELECOMMANDS_DROPPED"};
  Parameter<Link> link_;
  Parameter<Clients> clients_;
  communication::ToldEnds ends_;
  // Single-writer cells of the service loop: the wait-free hand-over to the cycle.
  Parameter<Link> shared_link_;
  Parameter<Clients> shared_clients_;
  Link next_link_{};
  Clients next_clients_{};
  TimePoint now_{};
  std::optional<TimePoint> closing_since_;
  std::uint32_t dropped_{0};  ///< telecommands that nobody took before the link was closed
  TimePoint last_rx_{};
  TimePoint last_client_{};
  std::array<std::uint64_t, GroundTransport::close_reasons> cuts_told_{};
  TimePoint next_cut_told_{};
  bool had_client_{false};
};

[[nodiscard]] std::unique_ptr<Subsystem> make_communication();
/// The same on a transport that is given.
[[nodiscard]] std::unique_ptr<Subsystem> make_communication_on(OpenGroundTransport open);

}  // namespace hirosco
