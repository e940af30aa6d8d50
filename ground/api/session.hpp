// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ground/api/device_faults.hpp"
#include "ground/api/open_pages.hpp"
#include "ground/archive/archive.hpp"
#include "ground/commands/commands.hpp"
#include "ground/downlink/catch_up.hpp"
#include "ground/downlink/downlink.hpp"
#include "ground/model/catalogue.hpp"
#include "ground/model/model.hpp"
#include "ground/people/alarms.hpp"
#include "ground/people/authority.hpp"
#include "ground/people/stacks.hpp"
#include "ground/replay/flights.hpp"

/// The ground station without sockets: takes octets and points in time, says what to send. Thread: one.
namespace hirosco::ground {

/// What the session asks of the shell around it.
struct Surroundings {
  /// Sends a telecommand to the spacecraft; false when it certainly does not leave. One that then could not leave after
  /// all comes back by `not_sent`.
  std::function<bool(Octets, Way)> send;
  /// One line to the control socket of a simulated device; the answer comes later, empty when nobody answers.
  std::function<void(const std::string& device, const std::string& line,
                     std::function<void(std::optional<std::string>)>)>
      ask_device;
  /// What was injected into simulated devices since the last call, whoever did it; without it only what clients do here is known.
  std::function<std::vector<StoredFault>()> injected{};
};

class Session {
 public:
  struct Parts {
    const Catalogue& catalogue;
    Archive& archive;
    const Clock& clock;
    Surroundings outside;
    std::uint16_t source{0x2000};  ///< of its telecommands, 0x2000 to 0x3FFF (decision 27)
    std::uint16_t first_count{0};
  };
  explicit Session(Parts parts);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // --- the link -----------------------------------------------------------------------------------------------------
  void link_up();
  void link_down();
  /// A telecommand that was to be sent has not left: its sender is told.
  void not_sent(Octets packet) { commands_.not_sent(packet); }
  /// Octets of the telemetry stream as they come, in pieces of any size. False: this is no telemetry, close the link.
  [[nodiscard]] bool receive(Octets octets);
  /// Batches to the clients, limits of time. Call 20 times a second.
  void tick();

  // --- requests (bodies as in ground/api/README.md) -----------------------------------------------------------------
  /// Of who commands, unless it is essential; what the descriptor marks only when it is confirmed.
  [[nodiscard]] Answered<nlohmann::json> command(const nlohmann::json& body);
  /// Who commands, and who asks for it.
  [[nodiscard]] nlohmann::json authority() const;
  [[nodiscard]] Answered<nlohmann::json> authority(const nlohmann::json& body);
  [[nodiscard]] Answered<nlohmann::json> alarm(const nlohmann::json& body);
  [[nodiscard]] Answered<nlohmann::json> keep_stack(const nlohmann::json& body);
  /// A name, or one more note.
  [[nodiscard]] Answered<nlohmann::json> tell_of_flight(const nlohmann::json& body);
  /// Answers through `done`, at the latest after 2 s.
  void preview(const nlohmann::json& body, std::function<void(Answered<nlohmann::json>)> done);
  void mode_preview(const nlohmann::json& body, std::function<void(Answered<nlohmann::json>)> done);
  [[nodiscard]] nlohmann::json status() const;
  /// Of the link, in every status.
  [[nodiscard]] nlohmann::json link_json() const;

  /// Whoever has a page open here.
  [[nodiscard]] OpenPages& pages() noexcept { return pages_; }
  [[nodiscard]] DeviceFaults& faults() noexcept { return faults_; }
  [[nodiscard]] const Catalogue& catalogue() const noexcept { return parts_.catalogue; }
  [[nodiscard]] Archive& archive() const noexcept { return parts_.archive; }
  [[nodiscard]] const Model& model() const noexcept { return model_; }
  [[nodiscard]] const Alarms& alarms() const noexcept { return alarms_; }
  [[nodiscard]] const Stacks& stacks() const noexcept { return stacks_; }
  [[nodiscard]] const Flights& flights() const noexcept { return flights_; }
  [[nodiscard]] const Clock& clock() const noexcept { return parts_.clock; }
  [[nodiscard]] bool connected() const noexcept { return connected_; }
  /// On-board time now as far as the ground can tell.
  [[nodiscard]] OnboardTime now() const;

 private:
  void take(const pus::TelemetryView& packet, Octets octets);
  /// What was missed and is known now.
  void take_past(const Heard& heard, OnboardTime t);
  void tell_event(const StoredEvent& event);
  void add_gap(OnboardTime from, OnboardTime to, CatchUp::After after = CatchUp::After::APacket);
  void tell_command(const StoredCommand& command);
  void tell_alarm(nlohmann::json alarm);
  void begin_flight();
  void keep(const StoredMark& mark);
  [[nodiscard]] Authority::Now both_times() const;

  Parts parts_;
  Model model_;
  Downlink downlink_;
  Commands commands_;
  CatchUp catch_up_;
  Flights flights_;
  Alarms alarms_;
  Stacks stacks_;
  Authority authority_;
  OpenPages pages_;
  DeviceFaults faults_;
  bool connected_{false};
  std::optional<OnboardTime>
      first_heard_;  ///< of a craft of which nothing was known, until it is known since when it flies
  TimePoint newest_received_{};
  std::optional<OnboardTime> archived_until_;  ///< by those before this process
  TimePoint next_housekeeping_{};
};

}  // namespace hirosco::ground
