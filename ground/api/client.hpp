// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "ground/api/session.hpp"
#include "ground/replay/replay.hpp"

namespace hirosco::ground {

/// One page: what it has been told, and where it is in the past when it replays. Housekeeping goes out when the network
/// has taken what went before, so that only the latest waits; all else is queued at once, and who lets too much of it
/// pile up is disconnected.
class Client {
 public:
  static constexpr std::size_t most_pending_octets = std::size_t{4} << 20;
  /// Above this, housekeeping waits.
  static constexpr std::size_t busy_octets = std::size_t{64} << 10;

  struct Who {
    std::string id;  ///< of this connection
    std::string seat;  ///< as in Authority, "" = none
    bool is_operator{false};
    std::string name{};
  };
  Client(Session& session, Peer& peer, Who who);
  [[nodiscard]] const Peer& peer() const noexcept { return peer_; }
  [[nodiscard]] const std::string& id() const noexcept { return who_.id; }
  [[nodiscard]] const std::string& seat() const noexcept { return who_.seat; }
  [[nodiscard]] bool is_operator() const noexcept { return who_.is_operator; }
  /// As its page says, for others.
  [[nodiscard]] const std::string& name() const noexcept { return who_.name; }
  [[nodiscard]] bool in_replay() const noexcept { return replay_.has_value(); }
  void received(const std::string& text);
  /// A message of the live view that must not be lost.
  void tell(const nlohmann::json& message);
  void tick(TimePoint now);

 private:
  void send(const nlohmann::json& message);
  void show(const Model& model, OnboardTime at, TimePoint now, bool replay);
  void begin_replay(double at, double speed);
  void play(TimePoint now);
  void announce_replay(TimePoint now);

  Session& session_;
  Peer& peer_;
  Who who_;
  bool closing_{false};
  std::uint64_t values_told_{0};
  std::uint64_t status_told_{0};
  bool status_due_{true};
  TimePoint status_at_{};
  bool connected_told_{false};
  std::optional<Replay> replay_;
  TimePoint replay_announced_{};
};

}  // namespace hirosco::ground
